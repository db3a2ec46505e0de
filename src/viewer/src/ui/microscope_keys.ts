// Keys of the microscope, the same on the live page and in a replay.
import type { FieldView } from "./field_view";

const kPressing = [" ", "Enter"], kChoosing = ["ArrowLeft", "ArrowRight", "ArrowUp", "ArrowDown"], kSliding = [...kChoosing, "Home", "End", "PageUp", "PageDown"];

/// True where the control in focus does something of its own with the key; then no page takes it away.
export function focusUses(event: KeyboardEvent, control: Element | null = document.activeElement): boolean {
  if (event.ctrlKey || event.altKey || event.metaKey) return false;
  if (control instanceof HTMLSelectElement) return kPressing.includes(event.key) || kSliding.includes(event.key) || /^[a-z]$/i.test(event.key); // a letter finds a line
  if (control instanceof HTMLButtonElement) return kPressing.includes(event.key);
  if (control instanceof HTMLAnchorElement) return kPressing.includes(event.key); // Space on a link scrolls the page
  if (!(control instanceof HTMLInputElement)) return false;
  switch (control.type) {
    case "range": return kSliding.includes(event.key);
    case "radio": return event.key === " " || kChoosing.includes(event.key);
    default: return event.key === " "; // a box to tick; text is seen to before any page
  }
}

/// True when the key was one of the microscope's.
export function microscopeKey(view: FieldView, event: KeyboardEvent, activeTool: number, panels: HTMLElement): boolean {
  if (event.ctrlKey || event.altKey || event.metaKey || focusUses(event)) return false;
  switch (event.key) {
    case "+": case "=": view.zoom(1); return true;
    case "-": case "−": view.zoom(-1); return true;
    case "[": view.focus(-1); return true;
    case "]": view.focus(1); return true;
    case "1": view.setStereo("mono"); return true;
    case "2": view.setStereo("side-by-side"); return true;
    case "3": view.setStereo("anaglyph"); return true;
    case ",": view.setEyeDistance(view.microscope.optics.eyeDistance - 1); return true;
    case ".": view.setEyeDistance(view.microscope.optics.eyeDistance + 1); return true;
    case "o": case "O": view.focusOnTool(activeTool); return true;
    case "g": case "G": view.toggleReticle(); return true;
    case "h": case "H": panels.classList.toggle("bare"); return true;
    case "0": view.reset(); return true;
    default: return false;
  }
}

/// Wheel and drag on the field where no hand is steered with the mouse. Returns what takes them off again.
export function microscopeMouse(view: FieldView, free: () => boolean): () => void {
  const wheel = (event: WheelEvent) => {
    const notches = -event.deltaY / 100;
    if (event.altKey) view.focus(notches);
    else if (event.ctrlKey || free()) view.zoom(notches);
    else return;
    event.preventDefault();
  };
  const drag = (event: PointerEvent) => {
    if (!free() || (event.buttons & 5) === 0) return;
    const mm = view.metresPerPixel * 1000;
    view.pan(-event.movementX * mm, event.movementY * mm);
  };
  view.surface.addEventListener("wheel", wheel, { passive: false });
  view.surface.addEventListener("pointermove", drag);
  return () => {
    view.surface.removeEventListener("wheel", wheel);
    view.surface.removeEventListener("pointermove", drag);
  };
}
