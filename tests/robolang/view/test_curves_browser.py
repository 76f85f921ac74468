"""Curves of charts in a browser: how they are drawn, and the values beside them while a run goes on."""

import pytest

from tests.robolang.view import made_up
from tests.robolang.view.browser import PATIENCE_MS, WITHOUT_GL, Tab, chromium

COLOURED = """() => {
  const canvas = document.querySelector("[data-signal=tool_error] canvas");
  const { data } = canvas.getContext("2d").getImageData(0, 0, canvas.width, canvas.height);
  let count = 0;
  for (let k = 0; k < data.length; k += 4) {
    const [least, most] = [Math.min(...data.slice(k, k + 3)), Math.max(...data.slice(k, k + 3))];
    count += data[k + 3] > 128 && most - least > 60 ? 1 : 0;
  }
  return count / canvas.width;
}"""
"""Coloured pixels of a chart in a column of pixels, on average."""


@pytest.fixture(scope="module")
def browser():
    with chromium(WITHOUT_GL) as started:
        yield started


def coloured(browser, path, *runs):
    tab = Tab(browser)
    page = tab.open(made_up.page(path, *runs))
    page.wait_for_selector("[data-signal=tool_error] output:not(:has-text('–'))", timeout=PATIENCE_MS)
    count = page.evaluate(COLOURED)
    tab.close()
    return count


def test_two_runs_of_different_times_are_two_lines_and_no_dots(browser, tmp_path):
    alone = coloured(browser, tmp_path / "one.html", made_up.run(4.8))
    both = coloured(browser, tmp_path / "two.html", made_up.run(4.8), made_up.run(4.1, label="fixed", phase=1.0))
    assert 1.0 < alone < 4.0
    # the second line is dashed and thinner
    assert 1.1 * alone < both < 2.0 * alone


def test_a_value_of_a_row_that_came_after_the_curve_was_drawn_is_shown(browser, tmp_path):
    tab = Tab(browser)
    page = tab.open(made_up.page(tmp_path / "one.html", made_up.run(4.8)))
    # rows that come with a frame; the charts are drawn anew after several of them
    page.evaluate("""() => {
      for (const signal of robolang.runs[0].signals.values()) signal.append(signal.columns.map(() => 0.5));
      robolang.runs[0].end = 4.801;
      robolang.viewer.player.extend();
      robolang.seek(4.801);
    }""")
    page.wait_for_selector("[data-signal=tool_error] output:has-text('500')", timeout=PATIENCE_MS)
    tab.close()
