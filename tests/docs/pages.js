// SPDX-License-Identifier: MIT
// Measures the open page. Its value is a list of problems: lines of "kind, picture, what", separated by tabs. The last
// line lists the measurements. Called by tests/docs/pages.
"use strict";

const LEAST_CONTRAST = 4.5; // what WCAG 2.2 asks of text, 1.4.3
const OVERLAP = 2; // [px] both ways: what the eye does not take for a collision
const ROUNDING = 0.01; // [px] of coordinates on the screen

const faults = [];
const fault = (kind, picture, what) => faults.push([kind, picture, what.replace(/\s+/g, " ").trim()].join("\t"));
const page = "the page";

const pen = document.createElement("canvas").getContext("2d");

// The ink of a text of a drawing, as boxes on the screen, one for each run of letters of one size.
function inkOf(text) {
    const toScreen = text.getScreenCTM();
    const walker = document.createTreeWalker(text, NodeFilter.SHOW_TEXT);
    const boxes = [];
    let at = 0;
    for (let node = walker.nextNode(); node; node = walker.nextNode()) {
        const letters = node.data;
        const style = getComputedStyle(node.parentElement);
        if (letters.trim() && at < text.getNumberOfChars()) {
            pen.font = `${style.fontStyle} ${style.fontWeight} ${style.fontSize} ${style.fontFamily}`;
            const ink = pen.measureText(letters);
            const from = text.getStartPositionOfChar(at);
            const to = text.getEndPositionOfChar(Math.min(at + letters.length, text.getNumberOfChars()) - 1);
            const across = [from.x - Math.max(0, ink.actualBoundingBoxLeft), to.x];
            const down = [from.y - ink.actualBoundingBoxAscent, from.y + ink.actualBoundingBoxDescent];
            const corners = across.flatMap((x) => down.map((y) => new DOMPoint(x, y).matrixTransform(toScreen)));
            const xs = corners.map((c) => c.x);
            const ys = corners.map((c) => c.y);
            boxes.push({ left: Math.min(...xs), right: Math.max(...xs), top: Math.min(...ys), bottom: Math.max(...ys) });
        }
        at += letters.length;
    }
    return boxes;
}

const overlap = (a, b) => Math.min(
    Math.min(a.right, b.right) - Math.max(a.left, b.left),
    Math.min(a.bottom, b.bottom) - Math.max(a.top, b.top),
);
const holds = (box, x, y) => box.left <= x && x <= box.right && box.top <= y && y <= box.bottom;

function colour(text) {
    const numbers = text.match(/[\d.]+/g)?.map(Number);
    return numbers && { rgb: numbers.slice(0, 3), opacity: numbers.length > 3 ? numbers[3] : 1 };
}

// WCAG 2.2: relative luminance, and the contrast of two of them.
function luminance(rgb) {
    const [r, g, b] = rgb.map((c) => (c / 255 <= 0.04045 ? c / 255 / 12.92 : ((c / 255 + 0.055) / 1.055) ** 2.4));
    return 0.2126 * r + 0.7152 * g + 0.0722 * b;
}
function contrast(a, b) {
    const [less, more] = [luminance(a), luminance(b)].sort((x, y) => x - y);
    return (more + 0.05) / (less + 0.05);
}

// The colour behind an element of the page.
function behind(element) {
    for (let e = element; e; e = e.parentElement) {
        const background = colour(getComputedStyle(e).backgroundColor);
        if (background && background.opacity === 1) {
            return background.rgb;
        }
    }
    return matchMedia("(prefers-color-scheme: dark)").matches ? [18, 18, 18] : [255, 255, 255];
}

// The colour behind the middle of a text of a drawing: of the last of its areas that was painted there before; none on an
// image.
function paintedBehind(drawing, areas, text, box) {
    const x = (box.left + box.right) / 2;
    const y = (box.top + box.bottom) / 2;
    let under = behind(drawing);
    for (const { shape, bounds } of areas) {
        if (!holds(bounds, x, y) || !(text.compareDocumentPosition(shape) & Node.DOCUMENT_POSITION_PRECEDING)) {
            continue;
        }
        if (shape.localName === "image") {
            under = null;
            continue;
        }
        const style = getComputedStyle(shape);
        const fill = style.fill === "none" ? null : colour(style.fill);
        const point = new DOMPoint(x, y).matrixTransform(shape.getScreenCTM().inverse());
        if (fill && fill.opacity * style.fillOpacity * style.opacity === 1 && shape.isPointInFill(point)) {
            under = fill.rgb;
        }
    }
    return under;
}

function checkContrast(where, words, ink, under) {
    const ratio = under ? contrast(ink, under) : 0;
    if (ratio < LEAST_CONTRAST) {
        fault("contrast", where, under ? `"${words}": ${ratio.toFixed(1)}` : `"${words}" stands on an image`);
    }
}

function measureDrawing(drawing, name) {
    const seen = (element) => getComputedStyle(element).visibility === "visible" && !element.closest("defs");
    const frame = drawing.getBoundingClientRect();
    const texts = [...drawing.querySelectorAll("text")].filter(seen).map((element) => ({
        element,
        words: element.textContent,
        boxes: inkOf(element),
    }));
    const areas = [...drawing.querySelectorAll("rect, path, polygon, image")].filter((shape) => !shape.closest("defs, clipPath"))
        .map((shape) => ({ shape, bounds: shape.getBoundingClientRect() }));
    texts.forEach((text, i) => {
        const beyond = Math.max(...[text.element.getBoundingClientRect(), ...text.boxes].flatMap((b) =>
            [frame.left - b.left, b.right - frame.right, frame.top - b.top, b.bottom - frame.bottom]));
        if (beyond > ROUNDING) {
            fault("outside", name, `"${text.words}", by ${beyond.toFixed(2)} px`);
        }
        for (const other of texts.slice(i + 1)) {
            const most = Math.max(...text.boxes.flatMap((a) => other.boxes.map((b) => overlap(a, b))));
            if (most > OVERLAP) {
                fault("overlap", name, `"${text.words}" and "${other.words}", by ${most.toFixed(1)} px`);
            }
        }
        for (const box of text.boxes) {
            checkContrast(name, text.words, colour(getComputedStyle(text.element).fill).rgb, paintedBehind(drawing, areas, text.element, box));
        }
    });
    return texts.length;
}

function measureProse() {
    const walker = document.createTreeWalker(document.body, NodeFilter.SHOW_TEXT);
    for (let node = walker.nextNode(); node; node = walker.nextNode()) {
        const parent = node.parentElement;
        if (node.data.trim() && !parent.closest("svg, script, style") && parent.checkVisibility()) {
            checkContrast(page, node.data.slice(0, 40), colour(getComputedStyle(parent).color).rgb, behind(parent));
        }
    }
}

const nameOf = (picture) => picture.closest("figure")?.id || "a picture without a name";
const pictures = [...document.querySelectorAll("svg, img, video, canvas")].filter((p) => !p.parentElement.closest("svg"));
let texts = 0;
for (const picture of pictures) {
    const alternative = picture.getAttribute("alt") ?? picture.getAttribute("aria-label");
    if (!alternative?.trim() && picture.getAttribute("aria-hidden") !== "true") {
        fault("alternative", nameOf(picture), "no alternative text");
    }
    if (picture.localName === "svg") {
        texts += measureDrawing(picture, nameOf(picture));
    }
}
measureProse();
for (const animation of document.getAnimations()) { // the window asks for less motion
    fault("motion", nameOf(animation.effect.target), "moves");
}
if (document.documentElement.scrollWidth > innerWidth) {
    fault("outside", page, `is ${document.documentElement.scrollWidth} px wide in a window of ${innerWidth}`);
}
const mode = matchMedia("(prefers-color-scheme: dark)").matches ? "dark" : "light";
faults.push(["measured", page, `${innerWidth} px, ${mode}, ${pictures.length} pictures, ${texts} texts`].join("\t"));
faults.join("\n");
