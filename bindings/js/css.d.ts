// SPDX-License-Identifier: MIT
import type { SpringParameters } from "./index.js";

/**
 * The motion of a spring from rest at 0 to 1 as an easing of CSS, for transitions and animations that run off the main thread:
 * `element.animate(keyframes, linear({ bounce: 0.2 }))`. The error is at most 0.2 % of the way for damping ratios from 0.1 to 5
 * (`bounce` from -0.8 to 0.9) without an initial velocity, and for damping ratios from 0.1 to 2 (`bounce` from -0.5 to 0.9) with
 * a velocity of up to 12/`duration`, which is 12 `hertz`. Beyond that it grows, and above about 5 % linear() throws a RangeError.
 *
 * @param options parameters only: an easing does not stop at its target, and has no tolerances of its own
 * @param velocity of the start, in ways per second; default 0
 * @returns `duration` in milliseconds, and `easing`: `linear(0, 0.009 1.8%, ..., 1)`
 */
export declare function linear(
    options?: SpringParameters & { [K in "restDelta" | "restSpeed" | "clamp" | "onRest"]?: never },
    velocity?: number,
): { duration: number; easing: string };
