// SPDX-License-Identifier: MIT
// Buttons, selects, and the text next to the scene.
import { Plot } from "./plots.mjs";
import { presets, sentences } from "./presets.mjs";

/* global REPORTED */ // whether tools/report was run, defined by bundle.mjs

const $ = (id) => document.getElementById(id);
const names = { water: "Water", cloth: "Cloth", rope: "Rope", jelly: "Jelly", curtain: "Curtain" };
const dampingUnit = { water: 5, cloth: 0.01, rope: 0.3, jelly: 0.01, curtain: 0.01 }; // [N s/m] per notch
const drawEvery = 150; // [ms] numbers and plots

function option(value, text, disabled = false) {
    const element = new Option(text, value);
    element.disabled = disabled;
    return element;
}

function seconds(t) {
    if (t === 0) return "none";
    if (!Number.isFinite(t)) return "any";
    if (t < 1e-4) return `${+(1e6 * t).toPrecision(3)} µs`;
    return t < 0.1 ? `${(1000 * t).toPrecision(3)} ms` : `${t.toPrecision(3)} s`;
}

function element(tag, attributes = {}, ...children) {
    const each = Object.assign(document.createElement(tag), attributes);
    each.append(...children);
    return each;
}

export class Controls {
    constructor(state, actions, stage) {
        Object.assign(this, { state, actions, stage });
        this.time = 0;
        this.micros = [];
        this.info = null;
        this.drawn = 0;
        this.trouble = "";
        this.remark = ""; // on the last choice
        this.energy = new Plot($("energy-plot"), false);
        this.error = new Plot($("error-plot"), true);
        $("scene").append(...Object.keys(presets).map((scene) => option(scene, names[scene])));
        this.connect();
    }

    connect() {
        const { state, actions } = this;
        $("scene").onchange = ({ target }) => actions.scene(target.value);
        $("method").onchange = ({ target }) => actions.method(0, target.value);
        $("other").onchange = ({ target }) => actions.method(1, target.value);
        $("pause").onclick = () => actions.pause();
        const failed = () => ""; // the notice says why
        $("once").onclick = () => actions.once().catch(failed);
        $("reset").onclick = () => actions.reset();
        const steps = (n) => {
            $("steps").value = this.limited(Math.round(n));
            actions.steps($("steps").valueAsNumber);
        };
        $("steps").onchange = ({ target }) => steps(target.valueAsNumber);
        $("fewer").onclick = () => steps(state.steps - 1);
        $("more").onclick = () => steps(state.steps + 1);
        $("speed").onchange = ({ target }) => actions.set("speed", Number(target.value));
        $("size").onchange = ({ target }) => actions.remakeWith("size", Number(target.value));
        $("damping").onchange = ({ target }) => {
            const damping = target.valueAsNumber * dampingUnit[state.scene];
            actions.remakeWith("damping", Number(damping.toPrecision(3)));
        };
        $("wind").oninput = ({ target }) => actions.wind(target.valueAsNumber);
        $("reference").onchange = (event) => actions.remakeWith("reference", event.target.checked);
        $("hash").onclick = async () => {
            actions.pause(true);
            $("hash-out").textContent = await actions.hash().catch(failed);
            this.command();
        };
    }

    /** The nearest number of steps that the page offers, or the usual one if there is no number. */
    limited(steps) {
        const { min, max } = $("steps");
        const nearest = Math.max(Number(min), Math.min(Number(max), steps));
        const used = Number.isNaN(steps) ? presets[this.state.scene].steps : nearest;
        this.remark =
            steps === used ? "" : `The number of steps ${steps} is not offered. The page uses ${used}.`;
        return used;
    }

    taken() {
        return this.info.methods.filter((method) => method.taken).map((method) => method.name);
    }

    // --- a new scene ------------------------------------------------------------------------------------------------

    made(info) {
        const { state } = this;
        this.info = info;
        this.time = 0;
        this.trouble = this.remark = "";
        this.micros = [];
        const options = () => info.methods.map(({ name, taken }) => option(name, this.label(name), !taken));
        $("method").replaceChildren(...options());
        $("other").replaceChildren(option("", "nothing"), ...options());
        const taken = this.taken();
        if (!taken.includes(state.method)) state.method = "leapfrog";
        if (state.other && !taken.includes(state.other)) state.other = "leapfrog";
        const sizes = presets[state.scene].sizes;
        $("size").replaceChildren(...sizes.map((size) => option(size, this.sizeText(size))));
        const [sentence, figure] = sentences[state.scene];
        $("sentence").textContent = sentence;
        if (REPORTED) {
            const link = element("a", { href: `../report/${figure}`, textContent: "Measured in the report" });
            $("sentence").append(" ", link, ".");
        }
        this.buildActions();
        this.buildPanes();
        const panes = state.other ? 2 : 1;
        this.energy.reset(panes);
        this.error.reset(panes);
        $("error-figure").hidden = !state.reference;
        $("hash-out").textContent = "";
        this.last = null;
        this.dirty = false;
        this.show();
    }

    label(name) {
        const words = {
            rk4: "Runge–Kutta 4",
            rkn8: "RKN 8",
            srkn6: "SRKN 6",
            "symplectic-euler": "symplectic Euler",
        };
        const text = words[name] ?? name;
        return text[0].toUpperCase() + text.slice(1);
    }

    sizeText(size) {
        const { scene } = this.state;
        return scene === "rope" ? `${size}` : scene === "jelly" ? `${size}³` : `${size}²`;
    }

    buildActions() {
        const { state, actions } = this;
        const button = (id, text, onclick) =>
            element("button", { type: "button", id, textContent: text, onclick });
        const side = this.info.length;
        const list = {
            water: () => [
                button("poke", "Poke", () => actions.poke(side * 0.35, side * 0.4, 6e4, (side * side) / 64)),
                button("rain", "Rain", () => actions.rain(state.rain ? 0 : 30)),
                button("ball", "Drop a ball", () => actions.ball(side * 0.6, side * 0.45, 0.9)),
            ],
            cloth: () => [
                button("poke", "Poke", () => actions.poke(side / 2, side / 2, 40, (side * side) / 8)),
                button("scissors", "Scissors", () => actions.set("scissors", !state.scissors)),
            ],
            rope: () => [
                button("poke", "Poke", () => actions.poke(side, 0, 30, 0.1)),
                button("heavy", "Heavy end, 1 : 10⁴", () => actions.remakeWith("heavy", !state.heavy)),
            ],
            curtain: () => [
                button("push", "Push a sphere through", () => {
                    actions.push(side / 2, -side / 2);
                    actions.letGo();
                }),
            ],
            jelly: () => [
                button("poke", "Poke", () => actions.poke(side / 2, side / 2, 250, (side * side) / 3)),
            ],
        };
        $("actions").replaceChildren(...list[state.scene]());
    }

    buildPanes() {
        const many = this.state.other ? 2 : 1;
        this.panes = Array.from({ length: many }, (_, i) => {
            const name = element("span", { className: "name" });
            const time = element("span", { className: "time" });
            const words = element("p");
            const again = element("button", {
                type: "button",
                className: "again",
                textContent: "Start again",
            });
            again.onclick = () => this.actions.reset();
            const boom = element("div", { className: "boom", hidden: true }, words, again);
            boom.setAttribute("role", "alert");
            const root = element("div", { className: "pane" }, name, time, boom);
            root.dataset.pane = i;
            return { root, name, time, words, boom };
        });
        $("panes").replaceChildren(...this.panes.map(({ root }) => root));
        this.place();
        this.placing ??= new ResizeObserver(() => this.place());
        this.placing.observe($("stage"));
    }

    place() {
        this.panes?.forEach(({ root }, i) => {
            const { x, y, w, h } = this.stage.box(i);
            Object.assign(root.style, { left: `${x}px`, top: `${y}px`, width: `${w}px`, height: `${h}px` });
            root.classList.toggle("below", y > 0);
        });
    }

    // --- what is chosen ---------------------------------------------------------------------------------------------

    show() {
        const { state } = this;
        if (!this.info) return;
        $("scene").value = state.scene;
        $("method").value = state.method;
        $("other").value = state.other;
        if (document.activeElement !== $("steps")) $("steps").value = state.steps; // else it may be half typed
        $("speed").value = state.speed;
        $("size").value = this.info.count[0];
        $("damping").value = Math.round(state.damping / dampingUnit[state.scene]);
        $("wind").value = state.wind;
        $("reference").checked = state.reference;
        $("pause").textContent = state.paused ? "Play" : "Pause";
        $("pause").setAttribute("aria-pressed", state.paused);
        for (const [id, on] of [
            ["rain", state.rain > 0],
            ["scissors", state.scissors],
            ["heavy", state.heavy],
        ])
            $(id)?.setAttribute("aria-pressed", on);
        for (const each of document.querySelectorAll(".of-cloth")) each.hidden = state.scene !== "cloth";
        this.command();
        [state.method, state.other].forEach((method, i) => {
            if (method && this.panes[i]) this.panes[i].name.textContent = this.label(method);
        });
        this.numbers();
    }

    command() {
        const words = this.actions.command();
        $("command").textContent = words;
        $("with-command").hidden = !words;
        $("no-command").hidden = Boolean(words);
    }

    /** Stops the scene until a new one is created. */
    fail(message) {
        this.trouble = `The physics has stopped: ${message}. Reset starts it again.`;
        this.notice();
    }

    notice() {
        $("notice").textContent = this.trouble || this.remark || (this.state.paused ? "paused" : "");
    }

    // --- what is measured -------------------------------------------------------------------------------------------

    frame({ panes }) {
        if (!this.panes || panes.length !== this.panes.length) return;
        this.last = panes;
        this.dirty = true;
        this.time = panes[0].time;
        this.micros = panes.map((pane) => pane.micros);
        const exploded = panes.map((pane) => pane.exploded !== null);
        const time = Math.max(...panes.map((pane) => pane.time));
        const energies = panes.map((pane) => (pane.exploded ? NaN : pane.energy.total));
        const errors = panes.map((pane) => pane.error);
        this.energy.add(time, energies, exploded);
        this.error.add(time, errors, exploded);
        panes.forEach(({ exploded: how, method }, i) => {
            const { boom, words } = this.panes[i];
            if (how && boom.hidden) {
                const stable = this.stable(method);
                const why =
                    this.stepNow() < stable
                        ? ""
                        : ` Its step of ${seconds(this.stepNow())} is not below the stable step, ${seconds(stable)}.`;
                const textContent = `${this.label(method)} exploded after ${how.time.toFixed(2)} s.`;
                words.replaceChildren(element("strong", { textContent }), why);
            }
            boom.hidden = !how;
        });
    }

    stepNow() {
        return 1 / (60 * this.state.steps);
    }

    stable(method) {
        return this.info.methods.find(({ name }) => name === method).stable;
    }

    /** Draws at intervals, no faster than one can read. */
    draw() {
        const now = performance.now();
        if (now - this.drawn < drawEvery || !this.dirty) return;
        this.drawn = now;
        this.dirty = false;
        this.energy.draw();
        if (this.state.reference) this.error.draw();
        this.last.forEach(({ time }, i) => {
            this.panes[i].time.textContent = `${time.toFixed(2)} s`;
        });
        this.numbers();
    }

    numbers() {
        const chosen = this.state.other ? [this.state.method, this.state.other] : [this.state.method];
        const of = (method) => this.info.methods.find(({ name }) => name === method);
        const unstable = (method) => !(this.stepNow() < this.stable(method));
        const head = chosen.map((method, i) => {
            const textContent = chosen.length > 1 ? this.label(method) : "";
            return element("th", { scope: "col", textContent, className: "ab"[i] });
        });
        const computing = (i) => (this.micros[i] > 0 ? `${Math.round(this.micros[i])} µs` : "–");
        const error = (i) => (this.last?.[i]?.error >= 0 ? `${this.last[i].error.toExponential(1)} m` : "–");
        const rows = [
            ["Step", () => seconds(this.stepNow())],
            ["Stable step", (method) => seconds(this.stable(method))],
            ["Evaluations a frame", (method) => `${of(method).forces * this.state.steps}`],
            ["Computing a frame", (_, i) => computing(i)],
        ];
        if (this.state.reference) rows.push(["Error now", (_, i) => error(i)]);
        const lines = rows.map(([title, text], line) => {
            const cells = chosen.map((method, i) => {
                const className = line === 0 && unstable(method) ? "bad" : "";
                return element("td", { textContent: text(method, i), className });
            });
            return element("tr", {}, element("th", { scope: "row", textContent: title }), ...cells);
        });
        const part = Math.min(1, this.stepNow() / this.stable(chosen[0]) / 2);
        const meter = element("meter", { min: 0, max: 1, low: 0.45, high: 0.5, optimum: 0, value: part });
        meter.title = "step over twice the stable step";
        meter.setAttribute("aria-label", "Step over twice the stable step");
        $("numbers").replaceChildren(
            element(
                "table",
                {},
                element("thead", {}, element("tr", {}, element("th"), ...head)),
                element("tbody", {}, ...lines),
            ),
            meter,
        );
        this.notice();
    }

    repaint() {
        this.energy.draw();
        this.error.draw();
    }
}
