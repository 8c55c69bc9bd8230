// Lets `panel` be moved inside its parent by dragging `grip`.
export function makeMovable(panel: HTMLElement, grip: HTMLElement): void {
  let from: { x: number; y: number } | null = null;
  grip.addEventListener("pointerdown", (event) => {
    if (event.button !== 0) return;
    from = { x: event.clientX - panel.offsetLeft, y: event.clientY - panel.offsetTop };
    grip.setPointerCapture(event.pointerId);
  });
  grip.addEventListener("pointermove", (event) => {
    if (!from) return;
    const room = panel.parentElement!;
    const clamp = (value: number, most: number) => `${Math.max(0, Math.min(value, most))}px`;
    panel.style.left = clamp(event.clientX - from.x, room.clientWidth - panel.offsetWidth);
    panel.style.top = clamp(event.clientY - from.y, room.clientHeight - panel.offsetHeight);
    panel.style.right = "auto";
  });
  for (const end of ["pointerup", "pointercancel"]) grip.addEventListener(end, () => (from = null));
}
