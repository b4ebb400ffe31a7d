// SPDX-License-Identifier: MIT
// @ts-self-types="./scenes.d.ts"
// Scenes with the WebAssembly module inside. What a program does not import, a bundler leaves out, the module as well.
import * as bare from "./bare.js";
import { binary } from "./binary.js";
import { embed } from "./module.js";

const withModule = (part) => {
    embed(binary);
    return part;
};

export const Scene = /* @__PURE__ */ withModule(bare.Scene);
export const components = /* @__PURE__ */ withModule(bare.components);
export const grid = /* @__PURE__ */ withModule(bare.grid);
export const methods = /* @__PURE__ */ withModule(bare.methods);
export const ready = /* @__PURE__ */ withModule(bare.ready);
export const soften = /* @__PURE__ */ withModule(bare.soften);
export const bendGrid = /* @__PURE__ */ withModule(bare.bendGrid);
export const bendMesh = /* @__PURE__ */ withModule(bare.bendMesh);
export const bendRod = /* @__PURE__ */ withModule(bare.bendRod);
export const fromMesh = /* @__PURE__ */ withModule(bare.fromMesh);
export const tethers = /* @__PURE__ */ withModule(bare.tethers);
export { TENSION_ONLY, TETHER } from "./mesh.js";
export { hasSimd } from "./simd.js";
