// SPDX-License-Identifier: Apache-2.0
// The viewer: one canvas, and what moves it.

const modes = [
    { id: "slider", name: "Slider", key: "s" },
    { id: "flicker", name: "Flicker", key: "f" },
    { id: "side", name: "Side by side", key: "b" },
    { id: "difference", name: "Difference", key: "d" },
    { id: "relative", name: "Relative", key: "r" },
    { id: "flip", name: "FLIP", key: "p" },
];
const state = {
    mode: "slider",
    left: 0,
    right: 1,
    second: false,
    zoom: 0,
    x: width / 2,
    y: height / 2,
    split: 0.5,
    exposure: 0,
    view: 0,
    channel: -1,
    range: { difference: 0, relative: 0 },
    tiles: false,
    automatic: false,
    pixel: null,
};
const isFalse = () => state.mode === "difference" || state.mode === "relative";
let stage, canvas, context;

const options = (names) =>
    names.map((name, i) => `<option value="${i}">${escape(name)}</option>`).join("");

const viewerHtml = () => `<h2>Images</h2>
<div class="bar">
<div class="modes" role="group" aria-label="What is shown">${modes
    .filter((m) => m.id !== "flip" || packed.flip.some(Boolean))
    .map((m) => `<button type="button" data-mode="${m.id}" title="key ${m.key}">${m.name}</button>`)
    .join("")}</div>
  <label>Left <select id="left">${options(letters)}</select></label>
  <label>Right <select id="right">${options(letters)}</select></label>
  <label>View <select id="view">${options(views.map((view) => view.name))}</select></label>
  <label><span>Exposure <output id="exposure-text"></output></span><input type="range" id="exposure"
  min="-10" max="10" step="0.25"></label>
  <label id="split-label">Divider <input type="range" id="split" min="0" max="1"
  step="0.005"></label>
  <label id="channel-label">Channel <select id="channel">
  <option value="-1">mean</option>${options(channels)}</select></label>
  <label id="range-label">Range <span><button type="button" data-range="0.5"
  aria-label="smaller range">−</button><button type="button" data-range="2"
  aria-label="larger range">+</button></span></label>
  <label class="check" id="automatic-label"><input type="checkbox" id="automatic"> by itself</label>
  <label class="check"><input type="checkbox" id="tiles"> tiles that differ</label>
  <div class="modes" role="group" aria-label="Zoom"><button type="button" data-zoom="in"
  aria-label="zoom in">+</button><button type="button" data-zoom="out"
  aria-label="zoom out">−</button><button type="button" data-zoom="fit">Fit</button><button
  type="button" data-zoom="one">1:1</button></div>
</div>
<div class="stage"><canvas id="canvas" tabindex="0" role="img"
  aria-label="The images; keys are listed below"></canvas><span class="tag"
  id="tag-left"></span><span class="tag" id="tag-right"></span></div>
<div class="scale" id="scale"><span></span><i></i><span></span></div>
<div class="wide"><table id="readout" aria-live="polite"></table></div>
<details><summary>Keys</summary><dl class="keys">
  ${modes.map((m) => `<dt><kbd>${m.key}</kbd></dt><dd>${m.name}</dd>`).join("")}
<dt><kbd>space</kbd></dt><dd>flick between left and right</dd><dt><kbd>a</kbd></dt><dd>flicker by
  itself</dd><dt><kbd>n</kbd></dt><dd>next right image</dd>
<dt><kbd>,</kbd> <kbd>.</kbd></dt><dd>divider</dd><dt><kbd>e</kbd> <kbd>E</kbd></dt><dd>exposure up,
  down by half a stop</dd><dt><kbd>v</kbd></dt><dd>next view</dd>
<dt><kbd>[</kbd> <kbd>]</kbd></dt><dd>smaller, larger range of the
  difference</dd><dt><kbd>t</kbd></dt><dd>tiles that differ</dd>
<dt><kbd>+</kbd> <kbd>−</kbd> <kbd>0</kbd> <kbd>1</kbd></dt><dd>zoom in, out, fit, one to one; the
  wheel and two fingers zoom too</dd>
<dt>arrows</dt><dd>move the images; with <kbd>shift</kbd> the chosen pixel</dd></dl></details>`;

// ---- places: canvas pixels of one pane, whose middle shows the image's point (state.x, state.y)

const panes = () =>
    state.mode === "side"
        ? [
              { x: 0, w: Math.floor(canvas.width / 2) },
              { x: Math.floor(canvas.width / 2), w: Math.ceil(canvas.width / 2) },
          ]
        : [{ x: 0, w: canvas.width }];
const fitZoom = () => Math.min(panes()[0].w / width, canvas.height / height);
const scale = () => state.zoom || fitZoom();
const toScreen = (pane, x, y) => [
    pane.x + pane.w / 2 + (x - state.x) * scale(),
    canvas.height / 2 + (y - state.y) * scale(),
];
function toImage(px, py) {
    const pane = panes().findLast((p) => px >= p.x) || panes()[0];
    return [
        state.x + (px - pane.x - pane.w / 2) / scale(),
        state.y + (py - canvas.height / 2) / scale(),
    ];
}

function zoomTo(zoom, px = panes()[0].w / 2, py = canvas.height / 2) {
    const [x, y] = toImage(px, py),
        before = scale();
    state.zoom = Math.min(256, Math.max(fitZoom() / 4, zoom));
    state.x = x - ((x - state.x) * before) / state.zoom;
    state.y = y - ((y - state.y) * before) / state.zoom;
    stayNear();
}
function stayNear() {
    state.x = Math.min(width, Math.max(0, state.x));
    state.y = Math.min(height, Math.max(0, state.y));
    update();
}
function fit() {
    Object.assign(state, { zoom: 0, x: width / 2, y: height / 2 });
    update();
}
function pick(x, y) {
    state.pixel =
        x >= 0 && y >= 0 && x < width && y < height ? { x: Math.floor(x), y: Math.floor(y) } : null;
    update();
}
/** Called by the tables. */
function goTo(x, y, zoom = 24, right = state.right) {
    Object.assign(state, {
        x: x + 0.5,
        y: y + 0.5,
        zoom,
        right,
        pixel: { x: Math.floor(x), y: Math.floor(y) },
    });
    update();
    stage.scrollIntoView({ block: "nearest" });
    canvas.focus({ preventScroll: true });
}

// ---- drawing

function range() {
    const relative = state.mode === "relative";
    if (!state.range[state.mode])
        state.range[state.mode] = usualSize(
            differences(state.left, state.right, state.channel, relative),
        );
    return state.range[state.mode];
}

/** What each pane shows: [picture, image or null]. */
function shown() {
    const image = (i) => [picture(i, state.exposure, state.view), i];
    if (isFalse())
        return [
            [
                differencePicture(
                    state.left,
                    state.right,
                    state.channel,
                    state.mode === "relative",
                    range(),
                ),
                null,
            ],
        ];
    if (state.mode === "flip") return [[flipPicture(state.right), null]];
    if (state.mode === "flicker") return [image(state.second ? state.right : state.left)];
    return [image(state.left), image(state.right)];
}

function drawPane(pane, from, clip) {
    const s = scale(),
        [x, y] = toScreen(pane, 0, 0);
    context.save();
    context.beginPath();
    context.rect(clip.x, 0, clip.w, canvas.height);
    context.clip();
    context.imageSmoothingEnabled = s < 1;
    context.drawImage(from[0], x, y, width * s, height * s);
    if (s >= 64 * devicePixelRatio && from[1] !== null) drawValues(pane, from[1]);
    if (state.tiles) drawTiles(pane);
    if (state.pixel) {
        const [px, py] = toScreen(pane, state.pixel.x, state.pixel.y),
            line = Math.max(2, devicePixelRatio * 1.5),
            size = Math.max(s, 5);
        for (const [colour, grow] of [
            ["#000", line],
            ["#fff", 0],
        ]) {
            context.strokeStyle = colour;
            context.lineWidth = line;
            context.strokeRect(
                px + (s - size) / 2 - grow,
                py + (s - size) / 2 - grow,
                size + 2 * grow,
                size + 2 * grow,
            );
        }
    }
    context.restore();
}

function drawValues(pane, image) {
    const s = scale(),
        line = s / (channels.length + 1),
        [x0, y0] = toImage(pane.x, 0).map(Math.floor);
    context.font = `${Math.min(line * 0.8, s / 6)}px system-ui, sans-serif`;
    context.textAlign = "center";
    context.textBaseline = "middle";
    for (let y = Math.max(0, y0); y < Math.min(height, y0 + canvas.height / s + 2); ++y)
        for (let x = Math.max(0, x0); x < Math.min(width, x0 + pane.w / s + 2); ++x)
            channels.forEach((_, c) => {
                const [px, py] = toScreen(pane, x + 0.5, y),
                    text = number(value(image, c, x, y), 4);
                context.lineWidth = line / 5;
                context.strokeStyle = "#000a";
                context.strokeText(text, px, py + line * (c + 1));
                context.fillStyle = "#fff";
                context.fillText(text, px, py + line * (c + 1));
            });
}

const tileCut = (length, parts, i) => Math.floor((length * i) / parts);
function drawTiles(pane) {
    const other = state.right || state.left,
        { tile_columns: columns, tile_rows: rows } = packed;
    if (!other) return;
    context.lineWidth = Math.max(1.5, devicePixelRatio);
    context.strokeStyle = "#ff2bd6";
    for (const t of packed.tiles[other - 1]) {
        const i = t % columns,
            j = Math.floor(t / columns);
        const [x0, y0] = toScreen(pane, tileCut(width, columns, i), tileCut(height, rows, j));
        const [x1, y1] = toScreen(
            pane,
            tileCut(width, columns, i + 1),
            tileCut(height, rows, j + 1),
        );
        context.strokeRect(x0, y0, x1 - x0, y1 - y0);
    }
}

function draw() {
    context.fillStyle = getComputedStyle(document.documentElement).getPropertyValue("--stage");
    context.fillRect(0, 0, canvas.width, canvas.height);
    const from = shown(),
        all = panes();
    if (state.mode === "slider") {
        const at = Math.round(state.split * canvas.width),
            line = Math.max(2, 2 * devicePixelRatio);
        drawPane(all[0], from[0], { x: 0, w: at });
        drawPane(all[0], from[1], { x: at, w: canvas.width - at });
        context.fillStyle = "#000";
        context.fillRect(at - line, 0, 2 * line, canvas.height);
        context.fillStyle = "#fff";
        context.fillRect(at - line / 2, 0, line, canvas.height);
        context.beginPath();
        context.arc(at, canvas.height / 2, 9 * devicePixelRatio, 0, 7);
        context.fill();
        context.stroke();
    } else {
        all.forEach((pane, i) => drawPane(pane, from[Math.min(i, from.length - 1)], pane));
        context.fillStyle = "#000";
        if (all.length > 1)
            context.fillRect(all[1].x - devicePixelRatio, 0, 2 * devicePixelRatio, canvas.height);
    }
}
