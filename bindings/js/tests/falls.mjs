// SPDX-License-Identifier: MIT
// The value of a spring and a hash of a scene, for tests/js to compare between Node, Bun and Chromium.
import { Spring } from "springstep";
import { grid, Scene } from "springstep/scenes";

export { ready } from "springstep/scenes";

export function falls() {
    const spring = new Spring(0, { hertz: 2, dampingRatio: 0.3 });
    spring.target = 1;
    for (let i = 0; i < 20; i++) spring.step(1 / 60);

    const sheet = grid({ count: [25, 25], spacing: 0.1, stiffness: 400, damping: 0.01, pinned: ["firstY"] });
    const scene = new Scene({ ...sheet, mass: 0.01, gravity: [0, -9.81, 0] });
    scene.advance("leapfrog", 1 / 1200, 300);
    let hash = 0xcbf29ce484222325n; // FNV-1a of 64 bits
    for (const quantity of ["position", "velocity"])
        for (const byte of new Uint8Array(scene.get(quantity).buffer))
            hash = ((hash ^ BigInt(byte)) * 0x100000001b3n) & 0xffffffffffffffffn;
    scene.free();
    return [spring.value, spring.velocity, hash.toString(16)].join();
}
