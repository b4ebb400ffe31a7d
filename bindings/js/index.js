// SPDX-License-Identifier: MIT
export { Spring } from "./spring.js";
export { Springs } from "./springs.js";
