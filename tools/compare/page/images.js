// SPDX-License-Identifier: Apache-2.0
// What the page knows, and its images as the canvas wants them.

const report = dataOf("report");
const packed = dataOf("pixels");
const { width, height } = report,
    pixelCount = width * height;
const channels = packed.channels,
    letters = report.images.map((image) => image.letter);

// ---- pixels

async function unpackBytes(text) {
    const letters64 = atob(text),
        bytes = new Uint8Array(letters64.length);
    for (let i = 0; i < bytes.length; ++i) bytes[i] = letters64.charCodeAt(i);
    const stream = new Blob([bytes]).stream().pipeThrough(new DecompressionStream("deflate"));
    return new Uint8Array(await new Response(stream).arrayBuffer());
}

/** The upper three bytes of floats, byte by byte. */
async function unpackFloats(text) {
    const bytes = await unpackBytes(text),
        n = bytes.length / 3,
        bits = new Uint32Array(n);
    for (let i = 0; i < n; ++i)
        bits[i] = (bytes[i] << 24) | (bytes[n + i] << 16) | (bytes[2 * n + i] << 8);
    return new Float32Array(bits.buffer);
}

let images = []; // of each image its floats, one channel after the other
let flipMaps = []; // of each image but the first; null where there is none
let views = []; // {name, encode(exposure) -> (r, g, b, bytes, at)}

async function unpackAll() {
    images = await Promise.all(packed.images.map(unpackFloats));
    flipMaps = await Promise.all(packed.flip.map((map) => map && unpackBytes(map)));
    const cubes = await Promise.all(
        packed.views.map(async (view) => ({ ...view, rgb: await unpackBytes(view.rgb) })),
    );
    views = [
        {
            name: "sRGB",
            encode: curve((v) =>
                v <= 0.0031308 ? 12.92 * v : 1.055 * Math.pow(v, 1 / 2.4) - 0.055,
            ),
        },
        { name: "Raw numbers", encode: curve((v) => v) },
        ...cubes.map((cube) => ({ name: `OCIO: ${cube.name}`, encode: cubeEncoder(cube) })),
    ];
}

const value = (image, channel, x, y) => images[image][channel * pixelCount + y * width + x];

// ---- from light to bytes

/** A curve for each channel, from a table over the floats' upper bits. */
function curve(f) {
    const table = new Uint8ClampedArray(1 << 17),
        bits = new Uint32Array(1),
        float = new Float32Array(bits.buffer);
    for (let i = 0; i < table.length; ++i) {
        bits[0] = (i << 14) | (1 << 13);
        table[i] = Number.isFinite(float[0]) ? 255 * f(float[0]) : 255;
    }
    return (exposure) => {
        const gain = Math.pow(2, exposure);
        const byte = (v) => {
            float[0] = v * gain;
            return v > 0 ? table[bits[0] >>> 14] : 0;
        };
        return (r, g, b, bytes, at) => {
            ((bytes[at] = byte(r)), (bytes[at + 1] = byte(g)), (bytes[at + 2] = byte(b)));
        };
    };
}

/** Interpolates in a view that OpenColorIO baked. */
function cubeEncoder({ side, low, high, rgb }) {
    const zero = Math.pow(2, low),
        steps = (side - 1) / (high - low),
        last = side - 1 - 1e-6;
    return (exposure) => {
        const gain = Math.pow(2, exposure);
        const place = (v) =>
            Math.min(last, Math.max(0, (Math.log2(Math.max(0, v * gain) + zero) - low) * steps));
        return (r, g, b, bytes, at) => {
            const x = place(r),
                y = place(g),
                z = place(b),
                i = x | 0,
                j = y | 0,
                k = z | 0,
                u = x - i,
                v = y - j,
                w = z - k;
            const base = 3 * (i + side * (j + side * k));
            for (let c = 0; c < 3; ++c) {
                const p = base + c,
                    dy = 3 * side,
                    dz = 3 * side * side;
                const edge = (q) => rgb[q] * (1 - u) + rgb[q + 3] * u;
                bytes[at + c] =
                    (edge(p) * (1 - v) + edge(p + dy) * v) * (1 - w) +
                    (edge(p + dz) * (1 - v) + edge(p + dz + dy) * v) * w;
            }
        };
    };
}

// ---- false colours

const mix = (stops, t) => {
    const at = Math.min(Math.max(t, 0), 1) * (stops.length - 1),
        i = Math.min(at | 0, stops.length - 2),
        f = at - i;
    return stops[i].map((v, c) => v + (stops[i + 1][c] - v) * f);
};
const signedStops = [
    [23, 78, 166],
    [106, 160, 222],
    [244, 244, 240],
    [232, 136, 96],
    [158, 26, 26],
];
const flipStops = [
    [0, 0, 4],
    [81, 18, 124],
    [183, 55, 121],
    [252, 137, 97],
    [252, 253, 191],
];
const colourTable = (stops) => Array.from({ length: 256 }, (_, i) => mix(stops, i / 255));
const signedColours = colourTable(signedStops),
    flipColours = colourTable(flipStops);
const gradient = (stops) => `linear-gradient(90deg, ${stops.map((s) => `rgb(${s})`).join(", ")})`;

/**
 * right - left of a channel, or of the mean of all, for each pixel; relative to |left| if asked,
 * where that is above a thousandth of the brightest.
 */
function differences(left, right, channel, relative) {
    const list = channel < 0 ? channels.map((_, c) => c) : [channel],
        out = new Float32Array(pixelCount);
    const mean = (image, i) =>
        list.reduce((sum, c) => sum + images[image][c * pixelCount + i], 0) / list.length;
    let most = 0;
    if (relative)
        for (let i = 0; i < pixelCount; ++i) {
            const v = Math.abs(mean(left, i));
            if (v > most && v < Infinity) most = v;
        }
    for (let i = 0; i < pixelCount; ++i) {
        const a = mean(left, i),
            b = mean(right, i);
        out[i] = relative ? (b - a) / Math.max(Math.abs(a), 1e-3 * most || 1) : b - a;
    }
    return out;
}

/** Some of the finite values, enough for quantiles, in ascending order. */
function sortedSome(values) {
    const step = Math.max(1, Math.floor(values.length / 100000));
    return values.filter((v, i) => i % step === 0 && Number.isFinite(v)).sort();
}

/** The size that all but one in a hundred stay below, as a round number. */
function usualSize(values) {
    const sizes = sortedSome(values).map(Math.abs).sort();
    const size = sizes[Math.floor(0.99 * (sizes.length - 1))] || sizes[sizes.length - 1] || 1,
        power = Math.pow(10, Math.floor(Math.log10(size)));
    return [1, 2, 5, 10].find((m) => m * power >= size * 0.999) * power;
}

// ---- pictures for the canvas, kept while nothing changes them

const kept = new Map();
function keptPicture(key, draw) {
    if (!kept.has(key)) {
        if (kept.size > 8) kept.delete(kept.keys().next().value);
        const canvas = Object.assign(document.createElement("canvas"), { width, height }),
            context = canvas.getContext("2d");
        const data = context.createImageData(width, height);
        draw(data.data);
        context.putImageData(data, 0, 0);
        kept.set(key, canvas);
    }
    return kept.get(key);
}

const odd = [255, 0, 255]; // what is not a number
function put(bytes, at, colour) {
    ((bytes[at] = colour[0]), (bytes[at + 1] = colour[1]), (bytes[at + 2] = colour[2]));
}

function picture(image, exposure, view) {
    return keptPicture(`image ${image} ${exposure} ${view}`, (bytes) => {
        const encode = views[view].encode(exposure),
            from = images[image],
            step = channels.length > 1 ? pixelCount : 0;
        for (let i = 0; i < pixelCount; ++i) {
            const r = from[i],
                g = from[i + step],
                b = from[i + 2 * step];
            if (Number.isFinite(r + g + b)) encode(r, g, b, bytes, 4 * i);
            else put(bytes, 4 * i, odd);
            bytes[4 * i + 3] = 255;
        }
    });
}

function differencePicture(left, right, channel, relative, range) {
    return keptPicture(`difference ${left} ${right} ${channel} ${relative} ${range}`, (bytes) => {
        differences(left, right, channel, relative).forEach((d, i) => {
            put(
                bytes,
                4 * i,
                Number.isFinite(d)
                    ? signedColours[
                          Math.min(255, Math.max(0, Math.round(127.5 + (127.5 * d) / range)))
                      ]
                    : odd,
            );
            bytes[4 * i + 3] = 255;
        });
    });
}

function flipPicture(right) {
    return keptPicture(`flip ${right}`, (bytes) => {
        flipMaps[right - 1].forEach((v, i) => {
            put(bytes, 4 * i, flipColours[v]);
            bytes[4 * i + 3] = 255;
        });
    });
}
