// SPDX-License-Identifier: MIT
// Small plots over the time of the scene, with one line per pane.
import uPlot from "uplot";

const most = 900; // points kept

function ink(name) {
    return getComputedStyle(document.documentElement).getPropertyValue(name).trim();
}

/** The range of a plot: all lines that have not exploded, or the part of a single line before it exploded. */
function limits(lines, exploded, log) {
    const held = lines.filter((_, i) => !exploded[i]);
    let values = (held.length ? held : lines).flat().filter((y) => Number.isFinite(y) && (!log || y > 0));
    if (values.length === 0) return log ? [1e-12, 1] : [0, 1];
    if (!held.length)
        values = values.sort((a, b) => Math.abs(a) - Math.abs(b)).slice(0, Math.ceil(values.length * 0.7));
    let low = values.reduce((a, b) => Math.min(a, b));
    let high = values.reduce((a, b) => Math.max(a, b));
    if (log) return [10 ** Math.floor(Math.log10(low)), 10 ** Math.ceil(Math.log10(high) + 0.01)];
    const room = 0.08 * (high - low) || 0.1 * Math.abs(high) || 1;
    return [low - room, high + room];
}

/** At most five powers of ten. */
function decades(u, axis, low, high) {
    const [first, last] = [Math.round(Math.log10(low)), Math.round(Math.log10(high))];
    const stride = Math.max(1, Math.ceil((last - first) / 4));
    const list = [];
    for (let power = first; power <= last; power += stride) list.push(10 ** power);
    return list;
}

export class Plot {
    constructor(element, log) {
        this.element = element;
        this.log = log;
        this.reset(1);
        new ResizeObserver(() => this.plot?.setSize(this.room())).observe(element);
    }

    room() {
        return { width: Math.max(180, this.element.clientWidth), height: 120 };
    }

    reset(panes) {
        this.times = [];
        this.lines = Array.from({ length: panes }, () => []);
        this.exploded = this.lines.map(() => false);
        this.plot?.destroy();
        // Colours are functions, because the colour scheme can change.
        const axis = {
            stroke: () => ink("--soft"),
            grid: { stroke: () => ink("--line"), width: 1 },
            ticks: { show: false },
        };
        const shown = (u, splits) =>
            splits.map((y) =>
                this.log || (y && Math.abs(y) < 1e-3) ? y.toExponential(0) : `${+y.toPrecision(6)}`,
            );
        this.plot = new uPlot(
            {
                ...this.room(),
                legend: { show: false },
                cursor: { show: false },
                padding: [8, 8, 0, 0],
                scales: {
                    x: { time: false },
                    y: { distr: this.log ? 3 : 1, range: () => limits(this.lines, this.exploded, this.log) },
                },
                axes: [
                    { ...axis, size: 24, values: (u, splits) => splits.map((t) => `${+t.toPrecision(6)} s`) },
                    {
                        ...axis,
                        size: 58,
                        values: shown,
                        ...(this.log ? { splits: decades, filter: (u, splits) => splits } : {}),
                    },
                ],
                series: [
                    {},
                    ...this.lines.map((_, i) => ({
                        stroke: () => ink(i ? "--pane-b" : "--pane-a"),
                        width: 2,
                        dash: i ? [7, 4] : undefined,
                        points: { show: false },
                    })),
                ],
            },
            [[], ...this.lines.map(() => [])],
            this.element,
        );
    }

    add(time, values, exploded) {
        if (this.times.length && !(time > this.times.at(-1))) return;
        this.times.push(time);
        values.forEach((value, i) =>
            this.lines[i].push(Number.isFinite(value) && (!this.log || value > 0) ? value : null),
        );
        this.exploded = exploded;
        if (this.times.length > most)
            for (const each of [this.times, ...this.lines]) each.splice(0, most / 3);
    }

    draw() {
        this.plot.setData([this.times, ...this.lines]);
    }
}
