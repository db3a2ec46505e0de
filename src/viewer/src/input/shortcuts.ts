// One table of keys: what the program does with them and what the help page says come from the same lines.

export interface Shortcut { keys: string; does: string }
export interface ShortcutGroup { title: string; shortcuts: Shortcut[] }

export const kShortcuts: ShortcutGroup[] = [
  {
    title: "Everywhere", shortcuts: [
      { keys: "?", does: "show or hide this list" },
      { keys: "Tab, Shift+Tab", does: "go to the next or previous control (outside the field)" },
      { keys: "Enter", does: "press the control in focus" },
      { keys: "Esc", does: "close a window; leave the field and go to the controls" },
      { keys: "M", does: "warning sounds on or off" },
    ],
  },
  {
    title: "Microscope", shortcuts: [
      { keys: "+  −", does: "magnification (also Ctrl + wheel)" },
      { keys: "[  ]", does: "focus down, up (also Alt + wheel)" },
      { keys: "O", does: "focus on the tip of the active hand" },
      { keys: "1  2  3", does: "one eye, side by side, red-cyan glasses" },
      { keys: ",  .", does: "eye distance" },
      { keys: "G", does: "reticle on or off" },
      { keys: "H", does: "hide or show the panels" },
      { keys: "0", does: "microscope back to its start" },
    ],
  },
  {
    title: "Hands (field in focus, pointer input)", shortcuts: [
      { keys: "Tab", does: "change the active hand; the other keeps pose and grip" },
      { keys: "X", does: "take up the scissors, or put them down" },
      { keys: "Mouse", does: "move the active hand in the focal plane; wheel: depth" },
      { keys: "Shift + drag", does: "tilt the handle;  right drag: roll" },
      { keys: "Space or left button", does: "close the grip while held; with the wheel: fine squeeze" },
      { keys: "K", does: "keep the grip as it is, or let go" },
      { keys: "W A S D, R F", does: "left hand: away, left, near, right; up, down" },
      { keys: "Arrows, PgUp PgDn", does: "right hand: the same" },
      { keys: "V  B", does: "close the left grip, the right grip" },
      { keys: "Q  E", does: "roll the active hand" },
      { keys: "I  J  Y  L", does: "tilt the active hand" },
      { keys: "Shift", does: "with a movement key: slowly" },
      { keys: "Ctrl", does: "clutch: move the mouse without moving the hand" },
      { keys: "P", does: "catch the mouse in the field (Esc lets go)" },
      { keys: "C", does: "cut; a spatula, in the hand and off the tissue: its next bend or width; a vessel's clamp: slides while held" },
      { keys: "N", does: "next; a spatula: lock or free its arm; a vessel's clamp: turn it over, or on to its next place" },
      { keys: "T", does: "a fresh suture, once both ends are cut and the needle is let go, where a task has several" },
      { keys: "U  Z", does: "take the upstream, the downstream clamp off a vessel (or close an instrument on the clamp's arm)" },
      { keys: "Gamepad", does: "sticks: hands; triggers: grips; bumpers: depth; X: cut; A: next" },
    ],
  },
  {
    title: "Replay (unless a slider of the microscope or a list is in focus)", shortcuts: [
      { keys: "Space", does: "play or pause" },
      { keys: "← →", does: "one second back or on;  with Shift: five" },
      { keys: "Home  End", does: "to the start, to the end" },
      { keys: "↑ ↓", does: "previous or next event" },
    ],
  },
];
