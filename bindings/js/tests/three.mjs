// SPDX-License-Identifier: MIT
// A geometry of three.js that shows a cloth: its vertices are the positions of the scene, without a copy.
import { BufferAttribute, BufferGeometry, Matrix4 } from "three";
import { grid, Scene } from "springstep/scenes";

const sheet = grid({ count: [25, 25], spacing: 0.1, stiffness: 400, pinned: ["lastY"] });
const cloth = new Scene({ ...sheet, mass: 0.01, gravity: [0, -9.81, 0] });
const geometry = new BufferGeometry();
const attribute = new BufferAttribute(cloth.positions, 3);
geometry.setAttribute("position", attribute);
geometry.computeBoundingBox();
const before = geometry.boundingBox.min.y;
cloth.advance("leapfrog", 1 / 2400, 400);
attribute.needsUpdate = true;
geometry.computeBoundingBox();
const after = geometry.boundingBox.min.y;
cloth.transform(new Matrix4().makeTranslation(0, 7, 0).elements);
geometry.computeBoundingBox();
const shifted = geometry.boundingBox.min.y;
console.log(
    attribute.array === cloth.positions && attribute.count === 625 && attribute.version === 1,
    before === 0 && after < -0.02,
    Math.abs(shifted - after - 7) < 1e-6,
);
