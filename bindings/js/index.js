// SPDX-License-Identifier: MIT
// @ts-self-types="./index.d.ts"
export { Spring } from "./spring.js";
export { Springs } from "./springs.js";
export { VelocityTracker } from "./tracker.js";
