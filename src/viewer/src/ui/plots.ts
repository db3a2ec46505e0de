// Curves over time with the events marked (uPlot), one chart for each unit.
import uPlot from "uplot";
import "uplot/dist/uPlot.min.css";
import type { Series, TimedEvent } from "../messages";
import { kFrequent, shownUnit, words } from "./format";

const kColours = ["#6fd3c0", "#f2b04e", "#b79cf0", "#f08a8a", "#9ac8f0", "#d7e07a"];
const kDashes = [[], [8, 4], [2, 3], [12, 3, 2, 3], [5, 5], [1, 4]]; // curves differ without colour

const kSmallest = 0.01; // in the unit shown; below it a curve is a line at rest, not a landscape of rounding errors

export interface ChartData { unit: string; titles: string[]; names: string[]; columns: (number | null)[][] }

/// Curves of one unit on one common time axis. Where a curve has no value at a time it has a gap (null), nothing is made up.
export function chartsOf(series: readonly Series[]): ChartData[] {
  const byUnit = new Map<string, Series[]>();
  for (const one of series) byUnit.set(one.unit, [...(byUnit.get(one.unit) ?? []), one]);
  return [...byUnit].map(([unit, group]) => {
    const times = [...new Set(group.flatMap((one) => one.time))].sort((a, b) => a - b);
    const at = new Map(times.map((time, i) => [time, i]));
    const [factor, shown] = shownUnit(unit);
    const columns: (number | null)[][] = [times];
    for (const one of group) {
      const column: (number | null)[] = new Array<number | null>(times.length).fill(null);
      one.time.forEach((time, i) => { column[at.get(time)!] = (one.value[i] ?? NaN) * factor; });
      columns.push(column);
    }
    return { unit: shown, titles: group.map((one) => one.title), names: group.map((one) => one.name), columns };
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

function markEvents(u: uPlot, events: readonly TimedEvent[]): void {
  const { ctx, bbox } = u;
  ctx.save();
  ctx.strokeStyle = "#ffffff40";
  ctx.fillStyle = "#d5e2e0";
  ctx.setLineDash([3, 3]);
  ctx.font = `${Math.round(10 * devicePixelRatio)}px system-ui, sans-serif`;
  let labelled = -Infinity;
  for (const event of events) {
    if (kFrequent.includes(event.name)) continue;
    const x = u.valToPos(event.time, "x", true);
    if (x < bbox.left || x > bbox.left + bbox.width) continue;
    ctx.beginPath();
    ctx.moveTo(x, bbox.top);
    ctx.lineTo(x, bbox.top + bbox.height);
    ctx.stroke();
    if (x - labelled < 70 * devicePixelRatio) continue; // leave room for the words
    ctx.fillText(words(event.name), x + 3, bbox.top + 10 * devicePixelRatio);
    labelled = x;
  }
  ctx.restore();
}
