type Attributes = Readonly<Record<string, string | number | boolean | undefined>>;

/** An element with attributes and children. Text of a run goes in as text only, here and everywhere. */
export function el<K extends keyof HTMLElementTagNameMap>(
  tag: K,
  attributes: Attributes = {},
  ...children: (Node | string)[]
): HTMLElementTagNameMap[K] {
  const made = document.createElement(tag);
  for (const [name, value] of Object.entries(attributes)) {
    if (value === undefined || value === false) continue;
    made.setAttribute(name, value === true ? "" : String(value));
  }
  made.append(...children);
  return made;
}

/** A button. Its name is its text, so that a voice can call what an eye reads; a button that shows a sign is named by its title. */
export function button(label: string, title: string, press: () => void, attributes: Attributes = {}): HTMLButtonElement {
  const made = el("button", { type: "button", "aria-label": label ? undefined : title, title, ...attributes }, label);
  made.addEventListener("click", press);
  return made;
}

/** A list of choices. */
export function select<T extends string | number>(
  title: string,
  choices: readonly (readonly [T, string])[],
  chosen: T,
  choose: (value: T) => void,
  attributes: Attributes = {},
): HTMLSelectElement {
  const made = el("select", { "aria-label": title, title, ...attributes });
  for (const [value, text] of choices) made.append(el("option", { value, selected: value === chosen }, text));
  made.addEventListener("change", () => {
    const choice = choices[made.selectedIndex];
    if (choice) choose(choice[0]);
  });
  return made;
}

const tokens = new Map<string, string>();

/** The value of a custom property of the style sheet: a colour of the theme. */
export function token(name: string): string {
  let value = tokens.get(name);
  if (value === undefined) {
    value = getComputedStyle(document.documentElement).getPropertyValue(name).trim();
    tokens.set(name, value);
  }
  return value;
}

/** The theme changed: its values are read anew. */
export function forgetTokens(): void {
  tokens.clear();
}
