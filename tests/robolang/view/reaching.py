"""Whether a page of any size shows what it has to: every control can be reached, and nothing covers it."""

SIZES = ((1400, 900), (1024, 768), (1000, 700), (800, 500), (420, 800))
LEAST_PICTURE_PX = 240
_COVERED = """() => {
  const all = [...document.querySelectorAll("button, input, select")];
  const shown = all.filter((one) => one.getClientRects().length > 0);
  const covered = shown.filter((one) => {
    one.scrollIntoView({ block: "center" });
    const { left, top, width, height } = one.getBoundingClientRect();
    const found = document.elementFromPoint(left + width / 2, top + height / 2);
    return !one.contains(found);
  });
  scrollTo(0, 0);
  const { scrollWidth, clientWidth } = document.documentElement;
  return {
    shown: shown.length,
    covered: covered.map((one) => one.dataset.testid ?? one.title),
    picture: document.querySelector(".stage").getBoundingClientRect().height,
    beyond: scrollWidth - clientWidth,
  };
}"""
_IN_SIGHT = """(names) => {
  scrollTo(0, document.documentElement.scrollHeight);
  const found = names.filter((name) => {
    const one = document.querySelector(`[data-testid=${name}]`);
    const { left, top, width, height } = one.getBoundingClientRect();
    return one.contains(document.elementFromPoint(left + width / 2, top + height / 2));
  });
  scrollTo(0, 0);
  return found;
}"""


def assert_all_can_be_reached(page, least, stays=()):
    """``least`` controls at each size, nothing over them; ``stays`` are in sight also at the end of the page."""
    for width, height in SIZES:
        page.set_viewport_size({"width": width, "height": height})
        page.wait_for_timeout(100)
        found = page.evaluate(_COVERED)
        assert found["shown"] > least, width
        assert found["covered"] == [], width
        assert found["picture"] >= LEAST_PICTURE_PX, width
        assert found["beyond"] <= 0, width
        assert page.evaluate(_IN_SIGHT, list(stays)) == list(stays), width
