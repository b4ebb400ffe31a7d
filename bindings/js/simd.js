// SPDX-License-Identifier: MIT
// Whether the engine can run scenes.

// A function that returns a SIMD vector.
const probe = [
    ...[0, 97, 115, 109, 1, 0, 0, 0, 1, 5, 1, 96, 0, 1, 123, 3, 2, 1, 0, 10, 10, 1, 8, 0, 65, 0, 253, 15],
    ...[253, 98, 11],
];

/** Whether the engine has SIMD for WebAssembly. */
export const hasSimd = () => typeof WebAssembly === "object" && WebAssembly.validate(Uint8Array.from(probe));
