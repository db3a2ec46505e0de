// Cividis, sampled at nine places: even in lightness, the same for people who see red and green alike (Nunez, Anderton & Renslow, PLoS ONE
// 13 (2018) e0199239).
const kCividis: [number, number, number][] = [[0, 34, 78], [33, 57, 110], [70, 82, 107], [98, 106, 111], [124, 123, 120], [152, 145, 116], [184, 170, 104], [218, 197, 83], [254, 232, 56]];

/// Red, green and blue, 0 to 1, of a share from 0 to 1 (held there).
export function cividis(share: number): [number, number, number] {
  const at = Math.min(1, Math.max(0, Number.isFinite(share) ? share : 0)) * (kCividis.length - 1);
  const low = Math.min(kCividis.length - 2, Math.floor(at)), part = at - low;
  return [0, 1, 2].map((c) => (kCividis[low][c] * (1 - part) + kCividis[low + 1][c] * part) / 255) as [number, number, number];
}

export function cividisRamp(): string {
  return `linear-gradient(90deg, ${kCividis.map((rgb, k) => `rgb(${rgb.join(" ")}) ${((100 * k) / (kCividis.length - 1)).toFixed(1)}%`).join(", ")})`;
}
