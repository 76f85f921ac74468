import { el } from "../dom";

export interface Tab {
  readonly id: string;
  readonly name: string;
  readonly content: HTMLElement;
}

/** Panels of which one is shown; on paper all are. */
export class Tabs {
  readonly element = el("section", { class: "tabs", "aria-label": "Program, notes and joints" });
  private readonly tabs: readonly Tab[];
  private readonly heads: readonly HTMLButtonElement[];

  constructor(tabs: readonly Tab[]) {
    this.tabs = tabs;
    this.heads = tabs.map((tab) => this.head(tab));
    const bar = el("div", { class: "bar", role: "tablist" }, ...this.heads);
    bar.addEventListener("keydown", (event) => this.key(event));
    this.element.append(bar);
    for (const tab of tabs) {
      const panel = el("div", { class: "tab", id: `tab-${tab.id}`, role: "tabpanel", "aria-labelledby": `head-${tab.id}` });
      panel.append(el("h2", { class: "paper" }, tab.name), tab.content);
      this.element.append(panel);
    }
    this.show(tabs[0]?.id ?? "");
  }

  show(id: string): void {
    this.tabs.forEach((tab, k) => {
      const on = tab.id === id;
      this.heads[k]?.setAttribute("aria-selected", String(on));
      if (this.heads[k]) this.heads[k].tabIndex = on ? 0 : -1;
      this.element.querySelector(`#tab-${tab.id}`)?.classList.toggle("shown", on);
    });
  }

  /** Write a number beside the name of a tab; 0: none. */
  count(id: string, count: number): void {
    const head = this.heads.find((made) => made.id === `head-${id}`);
    head?.querySelector(".badge")?.remove();
    if (count > 0) head?.append(el("span", { class: "badge" }, String(count)));
  }

  private head(tab: Tab): HTMLButtonElement {
    const made = el("button", { type: "button", role: "tab", id: `head-${tab.id}`, "aria-controls": `tab-${tab.id}`, "data-testid": `tab-${tab.id}` }, tab.name);
    made.addEventListener("click", () => this.show(tab.id));
    return made;
  }

  private key(event: KeyboardEvent): void {
    const by = event.key === "ArrowRight" ? 1 : event.key === "ArrowLeft" ? -1 : 0;
    if (by === 0) return;
    const at = this.heads.findIndex((head) => head.getAttribute("aria-selected") === "true");
    const next = (at + by + this.tabs.length) % this.tabs.length;
    this.show(this.tabs[next]?.id ?? "");
    this.heads[next]?.focus();
    event.preventDefault();
    event.stopPropagation();
  }
}
