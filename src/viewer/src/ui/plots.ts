// Curves over time with the events marked (uPlot), one chart for each unit, or more where one curve would flatten the others.
import uPlot from "uplot";
import "uplot/dist/uPlot.min.css";
import type { Series, TimedEvent } from "../messages";
import { kFrequent, shownUnit, words } from "./format";

const kColours = ["#6fd3c0", "#f2b04e", "#b79cf0", "#f08a8a", "#9ac8f0", "#d7e07a"];
const kDashes = [[], [8, 4], [2, 3], [12, 3, 2, 3], [5, 5], [1, 4]]; // curves differ without colour

const kSmallest = 0.01; // in the unit shown; below it a curve is a line at rest, not a landscape of rounding errors

const kFlattened = 20; // times smaller than the largest: drawn by itself

/// `smaller`: split off from a chart of the same unit.
export interface ChartData { unit: string; smaller: boolean; titles: string[]; names: string[]; columns: (number | null)[][] }

/// Curves apart where one is so much larger that another would be a line at rest. One that is at rest itself stays with the largest.
function apart(group: Series[], factor: number): Series[][] {
  const size = new Map(group.map((one) => [one, one.value.reduce<number>((most, v) => Math.max(most, Math.abs(v ?? 0) * factor), 0)]));
  const largest = Math.max(...size.values()), small = group.filter((one) => size.get(one)! * kFlattened < largest && size.get(one)! >= kSmallest);
  return small.length === 0 ? [group] : [group.filter((one) => !small.includes(one)), ...apart(small, factor)];
}

/// Curves of one unit on one common time axis. Where a curve has no value at a time it has a gap (null), nothing is made up.
export function chartsOf(series: readonly Series[]): ChartData[] {
  const byUnit = new Map<string, Series[]>();
  for (const one of series) byUnit.set(one.unit, [...(byUnit.get(one.unit) ?? []), one]);
  const groups = [...byUnit].flatMap(([unit, all]) => apart(all, shownUnit(unit)[0]).map((group, k) => ({ unit, group, smaller: k > 0 })));
  return groups.map(({ unit, group, smaller }) => {
    const times = [...new Set(group.flatMap((one) => one.time))].sort((a, b) => a - b);
    const at = new Map(times.map((time, i) => [time, i]));
    const [factor, shown] = shownUnit(unit);
    const columns: (number | null)[][] = [times];
    for (const one of group) {
      const column: (number | null)[] = new Array<number | null>(times.length).fill(null);
      one.time.forEach((time, i) => { column[at.get(time)!] = (one.value[i] ?? NaN) * factor; });
      columns.push(column);
    }
    return { unit: shown, smaller, titles: group.map((one) => one.title), names: group.map((one) => one.name), columns };
  });
}

/// Draws one chart into `holder`; follows its width.
export function drawChart(holder: HTMLElement, data: ChartData, events: readonly TimedEvent[], onpick: (time: number) => void): () => void {
  const axis = { stroke: "#b9cccb", grid: { stroke: "#ffffff14", width: 1 }, ticks: { stroke: "#ffffff30", width: 1 }, font: "12px system-ui, sans-serif" };
  const plot = new uPlot({
    width: Math.max(280, holder.clientWidth), height: 230,
    scales: { x: { time: false }, y: { range: (_, low, high) => (high - low < kSmallest ? [Math.min(0, low), Math.max(1, high)] : uPlot.rangeNum(low, high, 0.1, true)) } },
    cursor: { y: false },
    legend: { live: true, markers: { width: 2, dash: (_, i) => (i < 2 ? "solid" : i % 2 === 0 ? "dashed" : "dotted") } },
    axes: [{ ...axis, values: (_, ticks) => ticks.map((t) => `${+t.toFixed(2)} s`) },
      { ...axis, size: 64, label: data.unit || "value", labelFont: "12px system-ui, sans-serif", labelSize: 18 }],
    series: [{ label: "Time", value: (_, v) => (v === null ? "" : `${v.toFixed(2)} s`) }, ...data.titles.map((title, i) => ({
      label: title, stroke: kColours[i % kColours.length], dash: kDashes[i % kDashes.length], width: 1.6, spanGaps: true, points: { show: false },
      value: (_: uPlot, v: number | null) => (v === null ? "–" : `${v.toFixed(Math.abs(v) < 10 ? 2 : 0)} ${data.unit}`),
    }))],
    hooks: {
      drawClear: [(u) => markEvents(u, events)],
      ready: [(u) => u.over.addEventListener("dblclick", () => { const t = u.posToVal(u.cursor.left ?? 0, "x"); if (Number.isFinite(t)) onpick(t); })],
    },
  }, data.columns as uPlot.AlignedData, holder);
  const observer = new ResizeObserver(() => plot.setSize({ width: Math.max(280, holder.clientWidth), height: 230 }));
  observer.observe(holder);
  return () => { observer.disconnect(); plot.destroy(); };
}

/// The words of marks at `x`, or none where they would run into the words before them or over `end`.
export function labelsThatFit(marks: readonly { x: number; text: string }[], width: (text: string) => number, end: number): string[] {
  let free = -Infinity;
  return marks.map(({ x, text }) => {
    const to = x + width(text);
    if (x < free || to > end) return "";
    free = to;
    return text;
  });
}

function markEvents(u: uPlot, events: readonly TimedEvent[]): void {
  const { ctx, bbox } = u;
  ctx.save();
  ctx.strokeStyle = "#ffffff40";
  ctx.fillStyle = "#d5e2e0";
  ctx.setLineDash([3, 3]);
  ctx.font = `${Math.round(10 * devicePixelRatio)}px system-ui, sans-serif`;
  const end = bbox.left + bbox.width, room = 9 * devicePixelRatio;
  const marks = events.filter((one) => !kFrequent.includes(one.name)).map((one) => ({ x: u.valToPos(one.time, "x", true), text: words(one.name) })).filter(({ x }) => x >= bbox.left && x <= end);
  const labels = labelsThatFit(marks, (text) => ctx.measureText(text).width + room, end + room);
  marks.forEach(({ x }, k) => {
    ctx.beginPath();
    ctx.moveTo(x, bbox.top);
    ctx.lineTo(x, bbox.top + bbox.height);
    ctx.stroke();
    if (labels[k]) ctx.fillText(labels[k], x + 3, bbox.top + 10 * devicePixelRatio);
  });
  ctx.restore();
}
