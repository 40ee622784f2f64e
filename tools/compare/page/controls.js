// SPDX-License-Identifier: Apache-2.0
// What stands around the images, and what keys and pointers do.

// ---- what stands around it

function readout() {
    if (!state.pixel) return `<tr><td class="soft">Point at a pixel for its values.</td></tr>`;
    const { x, y } = state.pixel,
        l = letters[state.left],
        r = letters[state.right];
    const rows = channels.map((name, c) => {
        const a = value(state.left, c, x, y),
            b = value(state.right, c, x, y);
        const relative = a ? number((100 * (b - a)) / Math.abs(a), 3) + " %" : "–";
        const cells = [escape(name), number(a), number(b), number(b - a, 3), relative];
        return `<tr>${cells.map((cell) => `<td>${cell}</td>`).join("")}</tr>`;
    });
    return `<tr><th scope="col">${x + report.x0}, ${y + report.y0}</th><th scope="col">${l}</th>
        <th scope="col">${r}</th><th scope="col">${r} − ${l}</th>
        <th scope="col">relative</th></tr>${rows.join("")}`;
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
        ? `${letters[state.right]} − ${letters[state.left]}${
              state.mode === "relative" ? `, relative to ${letters[state.left]}` : ""
          }`
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
