/** What a key does, by the name of the key. */
export type Bindings = Readonly<Record<string, (event: KeyboardEvent) => void>>;

/** Bind keys for the whole page; fields that take keys themselves keep theirs. */
export function bindKeys(bindings: Bindings): void {
  addEventListener("keydown", (event) => {
    if (event.ctrlKey || event.metaKey || event.altKey) return;
    const target = event.target as HTMLElement;
    if (target.closest("dialog[open]") && event.key !== "?") return;
    if (keeps(target, event.key)) return;
    const action = bindings[event.key.length === 1 ? event.key.toLowerCase() : event.key];
    if (!action) return;
    event.preventDefault();
    action(event);
  });
}

const OF_SLIDERS = new Set(["ArrowLeft", "ArrowRight", "ArrowUp", "ArrowDown", "PageUp", "PageDown", "Home", "End"]);

/** Attributes of a slider that its keys move; that of the time goes by cycles and statements, as the whole page does. */
export const OWN_KEYS = { "data-own-keys": true } as const;

function keeps(target: HTMLElement, key: string): boolean {
  if (target.matches("select, textarea, input:not([type=range]):not([type=checkbox])")) return true;
  if (OF_SLIDERS.has(key)) return target.matches("[data-own-keys]");
  if (key === " ") return target.matches("button, input[type=checkbox], [role=button]");
  return false;
}
