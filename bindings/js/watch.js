// SPDX-License-Identifier: MIT
// Listeners of springs that may begin to move. The loop of animate.js is one.

/** The name of a method of Springs that returns whether steps would still change a value. */
export const moves = Symbol();

const listeners = new WeakMap();

/** Calls `listener` whenever a spring may begin to move; null: no longer. */
export function watch(spring, listener) {
    if (listener && listeners.get(spring)) throw new TypeError("the spring is animated by another loop");
    listeners.set(spring, listener);
}

export const changed = (spring) => listeners.get(spring)?.();
