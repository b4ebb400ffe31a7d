// SPDX-License-Identifier: MIT
// @ts-self-types="./bare.d.ts"
// Scenes without the WebAssembly module, which ready() gets.
export { methods } from "./definition.js";
export { components, grid, soften } from "./grid.js";
export { bendGrid, bendMesh, bendRod, fromMesh, TENSION_ONLY, TETHER, tethers } from "./mesh.js";
export { ready } from "./module.js";
export { Scene } from "./scene.js";
export { hasSimd } from "./simd.js";
