// SPDX-License-Identifier: MIT
// Server-side rendering: an import compiles nothing and needs no WebAssembly; single springs never do.
import { Spring, Springs } from "springstep";
delete globalThis.WebAssembly;
const { Scene, grid } = await import("springstep/scenes");
const spring = new Spring(0);
spring.target = 1;
console.log(spring.step(0.1) > 0, new Springs(2).step(0.1), typeof Scene, typeof grid);
