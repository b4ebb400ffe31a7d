// SPDX-License-Identifier: MIT
// Listeners of springs that may begin to move. The loop of animate.js is one. If a page has two copies of the package, the loop
// and the springs may use different copies of this file. The names are therefore symbols of the global registry.

/** The name of a method of Springs that returns whether steps would still change a value. */
export const moves = Symbol.for("springstep.moves");

/** The name of the field of a spring that has its listener. */
export const listener = Symbol.for("springstep.listener");

/** Calls a function whenever a spring may begin to move; null: no longer. */
export function watch(spring, call) {
    if (call && spring[listener]) throw new TypeError("the spring is animated by another loop");
    spring[listener] = call;
}

export const changed = (spring) => spring[listener]?.();
