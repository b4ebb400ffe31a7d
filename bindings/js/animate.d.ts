// SPDX-License-Identifier: MIT
import type { Spring, Springs } from "./index.js";

export interface AnimateOptions {
    /**
     * With `prefers-reduced-motion: reduce`, "jump" (default) places values on their targets, "run" moves them. "run" applies to
     * the spring, for all functions that draw it. If rest leads to the next target, by onRest or `finished`, values would jump in
     * each frame: do not start such an animation.
     */
    reducedMotion?: "jump" | "run";
}

/**
 * Advances a spring in every frame in which it moves, and calls `draw` after each step, and once in the next frame. The loop of
 * frames is shared by all springs. It starts when a target, value, velocity or parameter of one of them changes, and stops when
 * all are at rest. Errors in callbacks are reported, and the frame is still drawn. The result stops the animation of this `draw`
 * at once.
 */
export interface Animate {
    (spring: Spring, draw: (value: number, spring: Spring) => void, options?: AnimateOptions): () => void;
    (
        springs: Springs,
        draw: (value: Float64Array, springs: Springs) => void,
        options?: AnimateOptions,
    ): () => void;
}

/** Runs in requestAnimationFrame(), or on a timer where there is none. */
export declare const animate: Animate;

/** animate() with a loop of its own, for tests, servers and workers. */
export declare function animator(options?: {
    /** Requests a call of `frame` with the time in milliseconds. */
    request?: (frame: (time: number) => void) => unknown;
    /** The present time on the same clock. null, and the default with `request`: a motion begins at its first frame. */
    now?: (() => number) | null;
}): Animate;
