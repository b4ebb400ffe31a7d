// SPDX-License-Identifier: MIT
// @ts-self-types="./animate.d.ts"
// One loop of frames for any number of springs. It runs while one of them moves.
import { check } from "./options.js";
import { moves, watch } from "./watch.js";

const nextFrame = (frame) =>
    globalThis.requestAnimationFrame
        ? requestAnimationFrame(frame)
        : setTimeout(() => frame(performance.now()), 1000 / 60);
const isReduced = () => globalThis.matchMedia?.("(prefers-reduced-motion: reduce)").matches;

/** An error of one spring must not stop the others. */
function report(error) {
    if (globalThis.reportError) reportError(error);
    else
        setTimeout(() => {
            throw error;
        });
}

export function animator({
    request = nextFrame,
    now = request === nextFrame ? () => performance.now() : null,
} = {}) {
    check(typeof request === "function", "request", "a function", request, TypeError);
    check(now === null || typeof now === "function", "now", "a function or null", now, TypeError);
    const entries = new WeakMap(); // { spring, draws, time, stale, shown, failure } of a spring
    const moving = new Set();
    let requested = false;
    let drawing = false;

    function schedule() {
        if (!requested) request(frame);
        requested = true;
    }

    function wake(entry) {
        entry.stale = true;
        if (!drawing) entry.shown = null;
        if (moving.has(entry)) return;
        if (!drawing) entry.failure = null;
        entry.time = now ? now() : null; // of the start, so that no frame is too long
        moving.add(entry);
        // A draw function of another spring may only read the arrays. If it also writes, the values differ in the next frame.
        if (drawing && entry.spring[moves]) entry.shown = entry.spring.value.slice();
        schedule();
    }

    function frame(time) {
        requested = false;
        const reduced = isReduced();
        for (const entry of [...moving]) {
            if (!moving.has(entry)) continue; // a callback of another spring has stopped it
            // The time of a frame may be earlier than that of the event that started the motion.
            const dt = Math.max(0, time - (entry.time ?? time)) / 1000;
            entry.time = Math.max(time, entry.time ?? time);
            if (!advance(entry, dt, reduced)) moving.delete(entry);
        }
        if (moving.size > 0) schedule();
    }

    /** Advances and draws one spring, and returns whether it moves on. */
    function advance(entry, dt, reduced) {
        const { spring, draws, shown } = entry;
        [entry.stale, entry.shown] = [false, null];
        let failure = null; // the message of step(), which is reported once if it fails in each frame; "": onRest() failed
        try {
            if (reduced && ![...draws].some(({ runs }) => runs)) spring.finish();
            else spring.step(dt);
        } catch (error) {
            failure = error instanceof RangeError ? error.message : "";
            if (!failure || failure !== entry.failure) report(error);
        }
        entry.failure = failure;
        const { value } = spring;
        drawing = true;
        for (const { draw } of shown?.every((x, i) => Object.is(x, value[i])) ? [] : draws)
            try {
                draw(value, spring);
            } catch (error) {
                report(error);
            }
        drawing = false;
        // The callbacks may have written to the arrays of Springs.
        return spring[moves]?.() ?? (entry.stale || (failure === null && !spring.settled));
    }

    return function animate(spring, draw, options = {}) {
        check(typeof spring?.step === "function", "spring", "a Spring or Springs", spring, TypeError);
        check(typeof draw === "function", "draw", "a function", draw, TypeError);
        check(Object(options) === options, "options", "an object", options, TypeError);
        const { reducedMotion = "jump", ...more } = options;
        for (const name in more) check(false, "an option", "reducedMotion", name);
        const known = reducedMotion === "jump" || reducedMotion === "run";
        check(known, "reducedMotion", '"jump" or "run"', reducedMotion, TypeError);
        let entry = entries.get(spring);
        if (!entry) {
            entry = { spring, draws: new Set(), time: null, stale: false, shown: null, failure: null };
            watch(spring, () => wake(entry));
            entries.set(spring, entry);
        }
        const mine = { draw, runs: reducedMotion === "run" };
        entry.draws.add(mine);
        wake(entry);
        entry.shown = null; // to draw it once
        return function stop() {
            entry.draws.delete(mine);
            if (entry.draws.size > 0 || entries.get(spring) !== entry) return;
            entries.delete(spring);
            moving.delete(entry);
            watch(spring, null);
        };
    };
}

export const animate = /* @__PURE__ */ animator();
