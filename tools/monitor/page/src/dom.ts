export function element<T extends HTMLElement = HTMLElement>(id: string): T {
  const found = document.getElementById(id);
  if (!found) throw new Error(`the page has no #${id}`);
  return found as T;
}

export function setText(id: string, text: string): void {
  const to = element(id);
  if (to.textContent !== text) to.textContent = text;
}

// The same, with `commands` set as such.
export function setMarked(id: string, text: string): void {
  const to = element(id);
  if (to.dataset.shown === text) return;
  to.dataset.shown = text;
  const parts = text.split("`").map((part, i) => {
    const piece = document.createElement(i % 2 ? "code" : "span");
    piece.textContent = part;
    return piece;
  });
  to.replaceChildren(...parts);
}

// Colours as the style sheet has them, which knows light and dark.
export function color(name: string): string {
  return getComputedStyle(document.documentElement).getPropertyValue(`--${name}`).trim();
}

export const isDark = (): boolean => matchMedia("(prefers-color-scheme: dark)").matches;

export function onThemeChange(call: () => void): void {
  matchMedia("(prefers-color-scheme: dark)").addEventListener("change", call);
}

export function cell(text: string, className = ""): HTMLTableCellElement {
  const td = document.createElement("td");
  td.textContent = text;
  td.className = className;
  return td;
}
