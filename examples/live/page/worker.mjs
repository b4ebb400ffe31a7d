// SPDX-License-Identifier: MIT
// The simulation, in a worker so that it and drawing do not wait for each other. The page requests one tick at a time.
// A tick advances every pane by the time due and returns the positions to draw.
import { ready } from "springstep/scenes";
import { readPresets } from "../../../tools/scenes/presets.mjs";
import { Lab, listMethods, methodTable } from "./lab.mjs";
import { presets } from "./presets.mjs";

const longestTick = 0.1; // [s]; with longer ticks the scene runs slower than real time
const longestComputing = 50; // [ms] of a tick, so that commands do not wait; the time that remains is dropped
const portion = 16; // steps between reads of the clock, which take about 50 ms with the slowest settings
const tooFar = 15; // lengths of the scene; beyond, it counts as exploded although the numbers are still finite
const tearing = 2.2; // length over rest length at which links tear while a particle is held
const frail = 1.25; // the same for links of a curtain

/* global PRESETS */ // the text of tools/scenes/presets.c, defined by bundle.mjs
readPresets(PRESETS);

let run;
let panes = []; // {lab, method, exploded, busy, taken, micros}
let reference = null; // {lab, method}
let steps = 1;

function everyLab() {
    return reference ? [...panes.map((pane) => pane.lab), reference.lab] : panes.map((pane) => pane.lab);
}

function dropAll() {
    for (const lab of everyLab()) lab.free();
    panes = [];
    reference = null;
}

function newPane(method) {
    const pane = { lab: new Lab(run), exploded: null, micros: NaN };
    setMethod(pane, method);
    return pane;
}

// A method that the scene does not support can be chosen while the page still shows the previous scene.
function setMethod(pane, method) {
    Object.assign(pane, { method: pane.lab.takes(method) ? method : "leapfrog", busy: 0, taken: 0 });
}

// The reference uses the most accurate method. Its steps divide the steps of the panes, so that all have common times.
function newReference() {
    const lab = new Lab(run);
    const offered = [...methodTable.values()].filter(({ name }) => lab.takes(name));
    const { name } = offered.reduce((a, b) => (b.order > a.order ? b : a));
    return { lab, method: name };
}

function referenceSteps() {
    const enough = presets[run.scene].steps * (methodTable.get(reference.method).order > 4 ? 2 : 8);
    return steps * Math.max(2, Math.ceil(enough / steps));
}

function describe() {
    const { lab } = panes[0];
    const { particles, links, count, length, massRatio, ends, pinned } = lab;
    const methods = Array.from(methodTable.values(), ({ name, order, forcesPerStep }) => ({
        name,
        order,
        forces: forcesPerStep,
        taken: lab.takes(name),
        stable: lab.takes(name) ? lab.scene.stableStep(name) : NaN,
    }));
    return { run, particles, links, count, length, massRatio, ends, pinned, methods };
}

function make(settings) {
    dropAll();
    run = settings.run;
    steps = settings.steps;
    panes = settings.methods.map(newPane);
    if (settings.reference) reference = newReference();
    for (const lab of everyLab()) {
        if (settings.wind) lab.wind(settings.wind);
        if (settings.rain) lab.rain(settings.rain);
    }
    postMessage({ kind: "made", ...describe() });
    show("frame", { asked: true });
}

function advance(pane, n, late) {
    const start = performance.now();
    const taken = pane.lab.advance(pane.method, steps, n, late);
    pane.busy += performance.now() - start;
    pane.taken += taken;
    const far = pane.lab.farthest;
    if (!pane.exploded && (taken < n || !(far <= tooFar * pane.lab.length)))
        pane.exploded = { time: pane.lab.time };
    if (pane.busy > 20 || pane.taken > 60 * steps) {
        pane.micros = ((1000 * pane.busy) / pane.taken) * steps;
        pane.busy = pane.taken = 0;
    }
    return taken;
}

function advanceAll(n, evenExploded, late = 0) {
    for (const pane of panes) if (evenExploded || !pane.exploded) advance(pane, n, late);
    if (!reference || panes.every((pane) => pane.exploded)) return;
    const time = Math.max(...panes.map((pane) => (pane.exploded ? 0 : pane.lab.time)));
    const due = Math.round((time - reference.lab.time) * 60 * referenceSteps());
    if (due > 0) reference.lab.advance(reference.method, referenceSteps(), due, late);
}

function tear() {
    if (run.scene === "curtain") for (const lab of everyLab()) lab.tear(frail);
    if (run.scene === "cloth")
        for (const { lab, exploded } of panes) if (lab.hand.particle !== null && !exploded) lab.tear(tearing);
}

function picture(pane) {
    const { lab } = pane;
    const ball = lab.ball?.place ?? lab.sphere?.place ?? null;
    const positions = lab.positions(steps);
    const { method, exploded, micros } = pane;
    const error = reference && !exploded ? lab.distance(reference.lab) : NaN;
    const tears = run.scene === "cloth" || run.scene === "curtain";
    const torn = tears ? lab.cut.slice() : new Uint8Array(0);
    const { time, scene } = lab;
    return { positions, torn, ball, method, time, energy: scene.energy, exploded, micros, error };
}

function show(kind, more) {
    const pictures = panes.map(picture);
    const buffers = pictures.flatMap(({ positions, torn }) => [positions.buffer, torn.buffer]);
    postMessage({ kind, panes: pictures, steps, ...more }, buffers);
}

function tick(elapsed) {
    const end = performance.now() + longestComputing;
    let [due] = panes.map((pane) => pane.lab.due(Math.min(elapsed, longestTick), steps, 10 * steps));
    while (due > 0 && performance.now() < end) {
        const n = Math.min(due, portion);
        due -= n;
        advanceAll(n, false, panes[0].lab.pending + due / (60 * steps));
    }
    tear();
    show("frame");
}

// Requests of tests and buttons of the page that return an answer.
const questions = {
    step(frames) {
        for (let frame = 0; frame < frames; frame++) {
            advanceAll(steps, true);
            tear();
        }
        show("frame", { asked: true });
        return panes[0].lab.time;
    },
    hash: () => panes[0].lab.hash(),
    time: () => panes[0].lab.time,
    energy: () => panes[0].lab.scene.energy.total,
    position: (particle) => Array.from(panes[0].lab.positions(steps).slice(3 * particle, 3 * particle + 3)),
    difference: () => (reference ? panes[0].lab.distance(reference.lab) : NaN),
    sphere: () => panes[0].lab.sphere?.place ?? null,
    tornLinks: () => panes[0].lab.cut.subarray(0, panes[0].lab.links).reduce((sum, each) => sum + each, 0),
    cutTethers: () => panes[0].lab.cut.subarray(panes[0].lab.links).reduce((sum, each) => sum + each, 0),
};

const orders = {
    async start() {
        await ready();
        listMethods();
        postMessage({ kind: "ready" });
    },
    make,
    tick: ({ elapsed }) => tick(elapsed),
    steps: (message) => (steps = message.steps),
    method: ({ pane, method }) => panes[pane] && setMethod(panes[pane], method),
    touch: ({ call, values }) => everyLab().forEach((lab) => lab[call](...values)),
    ask({ id, question, parameters }) {
        postMessage({ kind: "answer", id, answer: questions[question](...parameters) });
    },
};

onmessage = ({ data }) => orders[data.kind](data);
onunhandledrejection = ({ reason }) => {
    throw reason; // so that the page is notified
};
