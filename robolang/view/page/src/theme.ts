import { button, forgetTokens } from "./dom";

type Theme = "light" | "dark";

/** Light or dark: as the system has it until somebody switches. Paper is always light. */
export class ThemeSwitch {
  readonly button: HTMLButtonElement;
  private chosen: Theme | null = null;
  private printing = false;
  private readonly system = matchMedia("(prefers-color-scheme: dark)");
  private readonly changed: () => void;

  constructor(changed: () => void) {
    this.changed = changed;
    this.button = button("", "Light or dark (T)", () => this.toggle(), { class: "icon theme" });
    this.system.addEventListener("change", () => this.apply());
    this.apply();
  }

  get theme(): Theme {
    if (this.printing) return "light";
    return this.chosen ?? (this.system.matches ? "dark" : "light");
  }

  toggle(): void {
    this.chosen = this.theme === "dark" ? "light" : "dark";
    this.apply();
  }

  print(on: boolean): void {
    this.printing = on;
    this.apply();
  }

  private apply(): void {
    if (document.documentElement.dataset.theme === this.theme) return;
    document.documentElement.dataset.theme = this.theme;
    this.button.setAttribute("aria-pressed", String(this.theme === "dark"));
    forgetTokens();
    this.changed();
  }
}
