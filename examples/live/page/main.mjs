// SPDX-License-Identifier: MIT
// The live page: connects the controls, the physics worker and the stage.
import { Controls } from "./controls.mjs";
import { Hand } from "./hand.mjs";
import { Physics } from "./physics.mjs";
import { commandOf, heavyEnd, heavySteps, presets } from "./presets.mjs";
import { Stage } from "./stage.mjs";

/* global WORKER */ // defined by bundle.mjs

/** Leaves nothing but a message, since the browser cannot run the page. */
function giveUp(message) {
    for (const id of ["bar", "panel"]) document.getElementById(id)?.remove();
    document.getElementById("notice").textContent = message;
}

function newStage() {
    try {
        return new Stage(document.getElementById("canvas"));
    } catch (error) {
        giveUp("This page draws with WebGL 2, and this browser does not offer it: there is nothing to see.");
        throw error;
    }
}

const stage = newStage();
const physics = new Physics(WORKER);
const still = matchMedia("(prefers-reduced-motion: reduce)");

/** The settings of a new scene; size 0 is that of the preset. */
function newScene(scene) {
    const { steps, speed } = presets[scene];
    return { scene, steps, speed, size: 0, damping: 0, heavy: false, wind: 0, rain: 0, scissors: false };
}

const state = {
    ...newScene("water"),
    method: "leapfrog",
    other: "",
    paused: still.matches,
    reference: false,
};
let touched = false; // since the scene began, so that no command reproduces it

function touch(call, ...values) {
    touched = true;
    physics.touch(call, ...values);
    controls.command();
}

/** Changes a setting of a running scene. Before the first step, it is a setting of the scene itself. */
function changeMidway(kind, how) {
    if (!state.paused || controls.time > 0) touched = true;
    physics.order(kind, how);
    controls.show();
}

function run() {
    const each = { scene: state.scene, ...presets[state.scene].more };
    if (state.size) each.size = state.size;
    if (state.damping) each.damping = state.damping;
    if (state.scene === "rope" && state.heavy) Object.assign(each, heavyEnd);
    return each;
}

function remake() {
    const { method, other, steps, reference } = state;
    touched = false;
    hand.stop();
    if (physics.failed) physics.start();
    physics.order("make", {
        run: run(),
        steps,
        methods: other ? [method, other] : [method],
        reference,
        wind: state.scene === "cloth" ? state.wind : 0,
        rain: state.scene === "water" ? state.rain : 0,
    });
}

const actions = {
    scene(scene) {
        Object.assign(state, newScene(scene));
        remake();
    },
    method(pane, name) {
        const before = state.other;
        if (pane === 0) state.method = name;
        else state.other = name;
        if (pane === 0) changeMidway("method", { pane, method: name });
        else if (Boolean(before) !== Boolean(name)) remake();
        else physics.order("method", { pane, method: name });
        controls.show();
    },
    steps(steps) {
        state.steps = steps;
        changeMidway("steps", { steps });
    },
    set(name, value) {
        state[name] = value;
        controls.show();
    },
    remakeWith(name, value) {
        state[name] = value;
        if (name === "heavy") state.steps = value ? heavySteps : presets.rope.steps;
        remake();
    },
    pause(paused = !state.paused) {
        state.paused = paused;
        controls.show();
    },
    once() {
        actions.pause(true);
        return physics.ask("step", 1);
    },
    reset: remake,
    poke: (x, y, force, area) => touch("poke", x, y, force, area),
    wind(speed) {
        state.wind = speed;
        touch("wind", speed);
        controls.show();
    },
    rain(rate) {
        state.rain = rate;
        touch("rain", rate);
        controls.show();
    },
    push: (x, z) => touch("push", x, z),
    letGo: () => physics.touch("letGo"),
    ball: (x, y, height) => touch("dropBall", x, y, height),
    hash: () => physics.ask("hash"),
    /** The command that prints the hash of the first pane; "": there is none. */
    command() {
        if (touched || presets[state.scene].own || state.wind > 0 || state.rain > 0) return "";
        return commandOf(run(), state.method, state.steps, controls.time).join(" ");
    },
};

const controls = new Controls(state, actions, stage);
const hand = new Hand(
    stage,
    document.getElementById("cursor"),
    {
        poke: (x, y) => actions.poke(x, y, 4e4, (stage.info.length ** 2 / 64) * 0.7),
        push: actions.push,
        letGo: actions.letGo,
        grab: (particle) => touch("grab", particle),
        drag: (to) => physics.touch("drag", ...to),
        release: () => physics.touch("release"),
        snip: (particle) => touch("snip", particle),
    },
    () => state.scene === "cloth" && state.scissors,
);

physics.onmade = (info) => {
    hand.begun();
    stage.build(info, state.other ? 2 : 1);
    controls.made(info);
};
physics.onfailed = (message) =>
    physics.works ? controls.fail(message) : giveUp(`This page cannot run: ${message}.`);
let fresh = false;
physics.onframe = (frame) => {
    stage.update(frame);
    controls.frame(frame);
    fresh = true;
};

let last = performance.now();
function animate(now) {
    requestAnimationFrame(animate);
    if (state.paused) last = now;
    else if (physics.tick(((now - last) / 1000) * state.speed)) last = now;
    if (devicePixelRatio !== stage.ratio) stage.sharpen(); // on another screen, with the same size in CSS pixels
    if (fresh) {
        stage.draw();
        fresh = false;
    }
    controls.draw();
}

matchMedia("(prefers-color-scheme: dark)").addEventListener("change", () => {
    stage.repaint();
    controls.repaint();
});
still.addEventListener("change", () => actions.pause(still.matches));

/** For tests and for the console; acts on the first pane. step() stops the clock. A running scene that was not touched
    is restarted first, so that exactly the given number of frames have passed. */
window.springstepLab = {
    async step(frames) {
        if (!state.paused && !touched) remake();
        actions.pause(true);
        return physics.ask("step", frames);
    },
    hash: () => physics.ask("hash"),
    time: () => physics.ask("time"),
    energy: () => physics.ask("energy"),
    poke: async (x, y, force, area) => {
        actions.poke(x, y, force, area);
        return physics.ask("time");
    },
    push: async (x, z) => {
        actions.push(x, z);
        actions.letGo();
        return physics.ask("time");
    },
    position: (particle) => physics.ask("position", particle),
    pixel: (particle) => stage.pixelOf(0, particle),
    difference: () => physics.ask("difference"),
    sphere: () => physics.ask("sphere"),
    tornLinks: () => physics.ask("tornLinks"),
    cutTethers: () => physics.ask("cutTethers"),
    command: () => actions.command(),
};

remake();
requestAnimationFrame(animate);
