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

const viewerHtml = () => `<h2>Images</h2>
<div class="bar">
  <div class="modes" role="group" aria-label="What is shown">${modes
      .filter((m) => m.id !== "flip" || packed.flip.some(Boolean))
      .map(
          (m) =>
              `<button type="button" data-mode="${m.id}" title="key ${m.key}">${m.name}</button>`,
      )
      .join("")}</div>
  <label>Left <select id="left">${letters.map((l, i) => `<option value="${i}">${l}</option>`).join("")}</select></label>
  <label>Right <select id="right">${letters.map((l, i) => `<option value="${i}">${l}</option>`).join("")}</select></label>
  <label>View <select id="view">${views.map((v, i) => `<option value="${i}">${escape(v.name)}</option>`).join("")}</select></label>
  <label><span>Exposure <output id="exposure-text"></output></span><input type="range" id="exposure" min="-10" max="10" step="0.25"></label>
  <label id="split-label">Divider <input type="range" id="split" min="0" max="1" step="0.005"></label>
  <label id="channel-label">Channel <select id="channel"><option value="-1">mean</option>${channels.map((c, i) => `<option value="${i}">${escape(c)}</option>`).join("")}</select></label>
  <label id="range-label">Range <span><button type="button" data-range="0.5" aria-label="smaller range">−</button><button type="button" data-range="2" aria-label="larger range">+</button></span></label>
  <label class="check" id="automatic-label"><input type="checkbox" id="automatic"> by itself</label>
  <label class="check"><input type="checkbox" id="tiles"> tiles that differ</label>
  <div class="modes" role="group" aria-label="Zoom"><button type="button" data-zoom="in" aria-label="zoom in">+</button><button type="button" data-zoom="out" aria-label="zoom out">−</button><button type="button" data-zoom="fit">Fit</button><button type="button" data-zoom="one">1:1</button></div>
</div>
<div class="stage"><canvas id="canvas" tabindex="0" role="img" aria-label="The images; keys are listed below"></canvas><span class="tag" id="tag-left"></span><span class="tag" id="tag-right"></span></div>
<div class="scale" id="scale"><span></span><i></i><span></span></div>
<div class="wide"><table id="readout" aria-live="polite"></table></div>
<details><summary>Keys</summary><dl class="keys">
${modes.map((m) => `<dt><kbd>${m.key}</kbd></dt><dd>${m.name}</dd>`).join("")}
<dt><kbd>space</kbd></dt><dd>flick between left and right</dd><dt><kbd>a</kbd></dt><dd>flicker by itself</dd><dt><kbd>n</kbd></dt><dd>next right image</dd>
<dt><kbd>,</kbd> <kbd>.</kbd></dt><dd>divider</dd><dt><kbd>e</kbd> <kbd>E</kbd></dt><dd>exposure up, down by half a stop</dd><dt><kbd>v</kbd></dt><dd>next view</dd>
<dt><kbd>[</kbd> <kbd>]</kbd></dt><dd>smaller, larger range of the difference</dd><dt><kbd>t</kbd></dt><dd>tiles that differ</dd>
<dt><kbd>+</kbd> <kbd>−</kbd> <kbd>0</kbd> <kbd>1</kbd></dt><dd>zoom in, out, fit, one to one; the wheel and two fingers zoom too</dd>
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

// ---- what stands around it

function readout() {
    if (!state.pixel) return `<tr><td class="soft">Point at a pixel for its values.</td></tr>`;
    const { x, y } = state.pixel,
        l = letters[state.left],
        r = letters[state.right];
    const rows = channels.map((name, c) => {
        const a = value(state.left, c, x, y),
            b = value(state.right, c, x, y);
        return `<tr><td>${escape(name)}</td><td>${number(a)}</td><td>${number(b)}</td><td>${number(b - a, 3)}</td><td>${a ? number((100 * (b - a)) / Math.abs(a), 3) + " %" : "–"}</td></tr>`;
    });
    return `<tr><th scope="col">${x + report.x0}, ${y + report.y0}</th><th scope="col">${l}</th><th scope="col">${r}</th><th scope="col">${r} − ${l}</th><th scope="col">relative</th></tr>${rows.join("")}`;
}

function controls() {
    const get = (id) => document.getElementById(id),
        visible = (id, on) => {
            get(id).hidden = !on;
            get(id).style.display = on ? "" : "none";
        };
    document
        .querySelectorAll("[data-mode]")
        .forEach((b) => b.setAttribute("aria-pressed", b.dataset.mode === state.mode));
    for (const id of ["left", "right", "view", "exposure", "split", "channel"])
        get(id).value = state[id];
    ((get("tiles").checked = state.tiles), (get("automatic").checked = state.automatic));
    get("exposure-text").textContent = `${state.exposure > 0 ? "+" : ""}${number(state.exposure)}`;
    visible("split-label", state.mode === "slider");
    visible("automatic-label", state.mode === "flicker");
    visible("channel-label", isFalse() && channels.length > 1);
    visible("range-label", isFalse());
    visible("scale", isFalse() || state.mode === "flip");
    const name = (i) => `${letters[i]}: ${report.images[i].files[0].split("/").pop()}`,
        two = state.mode === "slider" || state.mode === "side";
    const title = isFalse()
        ? `${letters[state.right]} − ${letters[state.left]}${state.mode === "relative" ? `, relative to ${letters[state.left]}` : ""}`
        : state.mode === "flip"
          ? `HDR-FLIP of ${letters[state.right]} against ${letters[0]}`
          : name(state.mode === "flicker" && state.second ? state.right : state.left);
    get("tag-left").textContent = title;
    get("tag-right").textContent = two ? name(state.right) : "";
    visible("tag-right", two);
    if (isFalse() || state.mode === "flip") {
        const [low, bar, high] = get("scale").children,
            most = isFalse() ? range() : 1,
            percent = state.mode === "relative";
        const text = (v) => (percent ? `${number(100 * v, 3)} %` : number(v, 3));
        low.textContent = isFalse() ? text(-most) : "0";
        high.textContent = isFalse() ? `+${text(most)}` : "1";
        bar.style.background = gradient(isFalse() ? signedStops : flipStops);
    }
    get("readout").innerHTML = readout();
}

let waiting = false;
function update() {
    if (state.mode === "flip" && !(state.right > 0 && flipMaps[state.right - 1]))
        state.right = 1 + flipMaps.findIndex(Boolean);
    controls();
    if (waiting) return;
    waiting = true;
    requestAnimationFrame(() => {
        waiting = false;
        draw();
    });
}

function resize() {
    const wide = stage.clientWidth,
        tall = Math.max(240, Math.min(innerHeight * 0.72, Math.max((wide * height) / width, 320)));
    canvas.style.height = `${tall}px`;
    canvas.width = Math.round(wide * devicePixelRatio);
    canvas.height = Math.round(tall * devicePixelRatio);
    update();
}

// ---- hands

function setMode(mode) {
    state.mode = mode;
    state.second = false;
    update();
}
function changeRange(factor) {
    if (isFalse()) state.range[state.mode] = range() * factor;
    update();
}
function resetRange() {
    state.range = { difference: 0, relative: 0 };
}

const keys = {
    " ": () => {
        if (state.mode === "flicker") state.second = !state.second;
        else {
            state.mode = "flicker";
            state.second = true;
        }
        update();
    },
    a: () => {
        state.mode = "flicker";
        state.automatic = !state.automatic;
        update();
    },
    n: () => {
        state.right = (state.right + 1) % letters.length;
        resetRange();
        update();
    },
    ",": () => {
        state.split = Math.max(0, state.split - 0.02);
        update();
    },
    ".": () => {
        state.split = Math.min(1, state.split + 0.02);
        update();
    },
    e: () => {
        state.exposure = Math.min(10, state.exposure + 0.5);
        update();
    },
    E: () => {
        state.exposure = Math.max(-10, state.exposure - 0.5);
        update();
    },
    v: () => {
        state.view = (state.view + 1) % views.length;
        update();
    },
    "[": () => changeRange(0.5),
    "]": () => changeRange(2),
    t: () => {
        state.tiles = !state.tiles;
        update();
    },
    "+": () => zoomTo(scale() * 1.5),
    "=": () => zoomTo(scale() * 1.5),
    "-": () => zoomTo(scale() / 1.5),
    0: fit,
    1: () => zoomTo(devicePixelRatio),
};
for (const m of modes)
    if (m.id !== "flip" || packed.flip.some(Boolean)) keys[m.key] = () => setMode(m.id);
const arrows = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, -1], ArrowDown: [0, 1] };

function onKey(event) {
    if (event.ctrlKey || event.altKey || event.metaKey) return;
    // Controls keep the keys that they know themselves.
    const here = event.target.closest("input, select, button, summary, a");
    if (arrows[event.key]) {
        if (here || event.target !== canvas) return;
        const [dx, dy] = arrows[event.key];
        if (event.shiftKey) {
            const at = state.pixel || { x: Math.floor(state.x), y: Math.floor(state.y) };
            pick(
                Math.min(width - 1, Math.max(0, at.x + dx)),
                Math.min(height - 1, Math.max(0, at.y + dy)),
            );
        } else {
            const step = (0.1 * canvas.height) / scale();
            ((state.x += dx * step), (state.y += dy * step));
            stayNear();
        }
    } else if (keys[event.key] && !(here && (event.key === " " || here.tagName === "SELECT"))) {
        keys[event.key]();
    } else {
        return;
    }
    event.preventDefault();
}

const fingers = new Map();
let dragging = null,
    moved = false;
const at = (event) => {
    const box = canvas.getBoundingClientRect();
    return [
        ((event.clientX - box.left) * canvas.width) / box.width,
        ((event.clientY - box.top) * canvas.height) / box.height,
    ];
};

function onDown(event) {
    canvas.setPointerCapture(event.pointerId);
    fingers.set(event.pointerId, at(event));
    moved = false;
    const near =
        Math.abs(at(event)[0] - state.split * canvas.width) <
        (event.pointerType === "mouse" ? 12 : 24) * devicePixelRatio;
    dragging = state.mode === "slider" && near && fingers.size === 1 ? "divider" : "image";
}
function onMove(event) {
    const now = at(event),
        before = fingers.get(event.pointerId);
    if (!before) {
        if (event.pointerType === "mouse") pick(...toImage(...now));
        return;
    }
    if (!moved && Math.hypot(now[0] - before[0], now[1] - before[1]) < 3 * devicePixelRatio) return;
    moved = true;
    if (dragging === "divider") {
        state.split = Math.min(1, Math.max(0, now[0] / canvas.width));
        fingers.set(event.pointerId, now);
        update();
    } else if (fingers.size === 1) {
        ((state.x -= (now[0] - before[0]) / scale()), (state.y -= (now[1] - before[1]) / scale()));
        fingers.set(event.pointerId, now);
        stayNear();
    } else {
        const other = [...fingers].find(([id]) => id !== event.pointerId)[1],
            apart = (p) => Math.max(1, Math.hypot(p[0] - other[0], p[1] - other[1]));
        zoomTo(
            (scale() * apart(now)) / apart(before),
            (now[0] + other[0]) / 2,
            (now[1] + other[1]) / 2,
        );
        fingers.set(event.pointerId, now);
    }
}
function onUp(event) {
    if (!fingers.delete(event.pointerId)) return;
    if (!moved && dragging === "image" && event.type === "pointerup")
        pick(...toImage(...at(event)));
}

function viewer(section) {
    section.innerHTML = viewerHtml();
    ((stage = section.querySelector(".stage")),
        (canvas = section.querySelector("canvas")),
        (context = canvas.getContext("2d")));
    section.addEventListener("input", (event) => {
        const { id, value: text, checked, type } = event.target;
        if (id in state) state[id] = type === "checkbox" ? checked : Number(text);
        if (["left", "right", "channel"].includes(id)) resetRange();
        update();
    });
    section.addEventListener("click", (event) => {
        const { mode, zoom, range: factor } = event.target.dataset;
        if (mode) setMode(mode);
        if (factor) changeRange(Number(factor));
        if (zoom) ({ in: keys["+"], out: keys["-"], fit, one: keys[1] })[zoom]();
    });
    canvas.addEventListener("pointerdown", onDown);
    canvas.addEventListener("pointermove", onMove);
    canvas.addEventListener("pointerup", onUp);
    canvas.addEventListener("pointercancel", onUp);
    canvas.addEventListener(
        "wheel",
        (event) => {
            event.preventDefault();
            zoomTo(scale() * Math.pow(1.0015, -event.deltaY), ...at(event));
        },
        { passive: false },
    );
    document.addEventListener("keydown", onKey);
    setInterval(() => {
        if (state.automatic && state.mode === "flicker") {
            state.second = !state.second;
            update();
        }
    }, 500);
    matchMedia("(prefers-color-scheme: dark)").addEventListener("change", update);
    new ResizeObserver(resize).observe(stage);
    resize();
}
