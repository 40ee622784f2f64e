// SPDX-License-Identifier: Apache-2.0
#include "woodcock/base/parse.h"
#include "woodcock/base/printable.h"
#include "woodcock/image/write_exr.h"
#include "woodcock/scene/keys/sections.h"
#include "woodcock/scene/keys/values.h"
#include "woodcock/scene/quality.h"

namespace woodcock::scene {
namespace {

using R = RenderDescription;
using A = render::Approximations;
using Base = const std::filesystem::path&;

/// What `parse` makes of a value's text; its complaints gain the value's place.
double parsedText(const TomlValue& value, double parse(std::string_view)) {
    const std::string text = value.text();
    try {
        return parse(text);
    } catch (const Error& e) {
        throw inputError("{}: {}: {}", value.place(), value.name(), e.what());
    }
}

/// A number, or a text such as "1%" that `parse` makes one of.
Value<double> numberOrText(NumberRange range, double parse(std::string_view)) {
    Value<double> value = number(range);
    value.read = [=](const TomlValue& v, Base) {
        return v.isText() ? parsedText(v, parse) : v.number(range);
    };
    return value;
}

Value<std::uint64_t> seed() {
    return {"integer, 0..2^63 - 1",
            {"42"},
            [](const TomlValue& v, Base) { return v.count(); },
            [](const std::uint64_t& v, const SceneWriter&) {
                if (v >> 63 != 0)
                    throw usageError("the seed {} is larger than a scene file can hold (2^63 - 1)",
                                     v);
                return std::to_string(v);
            }};
}

Value<Denoise> denoise() {
    const std::string condition = "if_installed";
    return {fmt::format("`true`, `false` or `\"{}\"`", condition),
            {"true", tomlText(condition)},
            [=](const TomlValue& v, Base) {
                if (!v.isText()) return v.flag() ? Denoise::Always : Denoise::Never;
                if (v.text() == condition) return Denoise::IfInstalled;
                throw v.error("is '{}'; expected true, false or \"{}\"", shown(v.text(), 60),
                              condition);
            },
            [=](const Denoise& value, const SceneWriter&) -> std::string {
                if (value == Denoise::IfInstalled) return tomlText(condition);
                return value == Denoise::Always ? "true" : "false";
            }};
}

Key<R> resolution() {
    Key<R> key;
    key.info = {.name = "resolution",
                .doc = "pixels",
                .type = fmt::format("`[width, height]`, 1..{}", largestImageSide),
                .fallback = fmt::format("[{}, {}]", R().width, R().height),
                .example = "[321, 123]"};
    key.read = [](const TomlValue& v, R& r, Base) {
        const auto sides = v.elements("[width, height]", 2);
        r.width = sides[0].integer(1, largestImageSide);
        r.height = sides[1].integer(1, largestImageSide);
    };
    key.write = [](const R& r, const SceneWriter&) {
        return Written{fmt::format("[{}, {}]", r.width, r.height)};
    };
    key.member = [](const R& r) { return static_cast<const void*>(&r.width); };
    return key;
}

/// It says something of marching alone.
Key<R> marchEstimate() {
    Key<R> k = key({.name = "march_estimate",
                    .doc = "how marched optical depths become transmittance: by two look-ups a "
                           "step, or by one. It needs `march_step`",
                    .beside = "march_step = 0.5",
                    .choice = true},
                   &R::approximations, &A::jackknife,
                   choice<bool>("estimate", {{true, "jackknife"}, {false, "exponential"}}));
    k.write = [write = k.write](const R& r, const SceneWriter& out) {
        return r.approximations.marchStep != 0 ? write(r, out) : std::nullopt;
    };
    return k;
}

/// Voxels of reduced precision.
Key<R> storageKey() {
    Key<R> k = key({.name = "storage",
                    .doc = "for volumes that have no `storage` of their own. `\"half\"`, "
                           "`\"fixed16\"` and `\"fixed8\"` are biased; see \"Fields\"",
                    .choice = true},
                   &R::storage, storage());
    k.biased = [](const R& r) { return isReducedPrecision(r.storage); };
    return k;
}

/// How many samples, and of which scene: no choices.
std::vector<Key<R>> amountKeys() {
    return {
        resolution(),
        key({.name = "fps",
             .doc = "frames per second, by which velocities per second become motion within the "
                    "shutter",
             .comment = "frames per second"},
            &R::fps, number(positive)),
        key({.name = "spp",
             .doc = "samples per pixel. An adaptive render does the same work, but with another "
                    "number in each pixel",
             .comment = "samples per pixel",
             .always = true,
             .inDigest = false},
            &R::spp, integer(1)),
        key({.name = "seed",
             .doc = "of the random numbers. Another seed gives other noise",
             .inDigest = false},
            &R::seed, seed()),
        otherWay<R>({.name = std::string(qualityKey),
                     .doc = "a set of choices, see \"Qualities\"",
                     .type = choiceOf<Quality>("quality", qualityNames).type,
                     .fallback = "none",
                     .example = "\"draft\"",
                     .choice = true}),
        biasedWhenSaid(key({.name = "max_scatterings",
                            .doc = "biased. Paths that scatter more often in media are cut, which "
                                   "darkens the picture",
                            .method = true},
                           &R::maxScatterings, integer(0))),
        biasedWhenSaid(key(
            {.name = "max_bounces",
             .doc =
                 "biased. Paths that meet surfaces more often are cut, which darkens the picture",
             .method = true},
            &R::maxBounces, integer(0))),
    };
}

std::vector<Key<R>> approximationKeys() {
    return {
        biasedWhenSaid(key({.name = "transparent_shadows",
                            .doc = "biased. Shadow rays go straight through dielectrics, dimmed by "
                                   "Fresnel's transmittance. Less noise behind glass, but no "
                                   "caustics and no refracted shadows",
                            .choice = true},
                           &R::approximations, &A::transparentShadows, flag())),
        biasedWhenSaid(key({.name = "march_step",
                            .doc = "biased. Rays are marched in steps of at most so many voxels "
                                   "instead of tracked; 0: tracked. See \"Ray marching\"",
                            .comment = "voxels",
                            .choice = true},
                           &R::approximations, &A::marchStep, number({0, 1000}))),
        marchEstimate(),
        biasedWhenSaid(key({.name = "similarity_after",
                            .doc = "biased. After so many scatterings (0: from the camera on) "
                                   "media scatter evenly in all directions, (1 - g) times as "
                                   "often; see \"Similarity, octaves\"",
                            .choice = true},
                           &R::approximations, &A::similarityAfter, integer(0))),
        biasedWhenSaid(key({.name = "octaves",
                            .doc = "biased. Multiple scattering as so many octaves of single "
                                   "scattering instead of paths; 0: paths. See \"Similarity, "
                                   "octaves\"",
                            .choice = true},
                           &R::approximations, &A::octaves, integer(0, 16))),
        biasedWhenSaid(key(
            {.name = "clamp",
             .doc =
                 "biased. The largest radiance that one path may bring, in its brightest channel. "
                 "Brighter paths are dimmed and keep their colour. Their number is in the log and "
                 "in `--stats`. What falls on shadow catchers is not clamped. 0: no limit",
             .choice = true},
            &R::approximations, &A::clamp, number(notNegative))),
        storageKey(),
        biasedWhenSaid(key(
            {.name = "lookup",
             .doc =
                 "`\"nearest\"` is biased: it takes the voxel nearest to a point; see \"Fields\"",
             .choice = true},
            &R::lookup,
            choice<grid::Lookup>("lookup", {{grid::Lookup::Trilinear, "trilinear"},
                                            {grid::Lookup::Nearest, "nearest"}}))),
        biasedWhenSaid(key(
            {.name = "level_of_detail",
             .doc = "biased. Grids are coarsened by powers of two, as long as the voxels nearest "
                    "to the camera are at most so many pixels wide. 0: never. See \"Fields\"",
             .comment = "pixels",
             .choice = true},
            &R::levelOfDetail, number({0, 1000}))),
    };
}

std::vector<Key<R>> effortKeys() {
    return {
        key({.name = "adaptive",
             .doc = "pixels whose error is large get more samples, others fewer, in the same "
                    "time; see \"Adaptive sampling\"",
             .fallback = "false",
             .inDigest = false,
             .choice = true},
            &R::adaptive, flag()),
        biasedWhenSaid(key(
            {.name = "denoise",
             .doc =
                 "biased. The finished picture is denoised by Open Image Denoise, which has to be "
                 "installed; `\"if_installed\"` does so only where it is. See \"Denoising\"",
             .inDigest = false,
             .choice = true},
            &R::denoise, denoise())),
        key({.name = "time_limit",
             .doc = "in seconds, or a text such as `\"90s\"`, `\"2m\"`, `\"1.5h\"`. 0: none. The "
                    "first sample of all pixels may take twice as long. Pixels that still have no "
                    "sample are black with alpha 0, and the log says how many they are",
             .comment = "seconds",
             .inDigest = false},
            &R::timeLimit, numberOrText(notNegative, parseDuration)),
        key({.name = "noise",
             .doc = "the render stops when the noise is below this number, or below a text such as "
                    "`\"1%\"`. 0: never. See \"Errors\"",
             .inDigest = false},
            &R::noise, numberOrText(zeroToOne, parseFraction)),
        key({.name = "majorant_scale",
             .doc = "loosens the bounds of tracking, for experiments. It costs time and changes no "
                    "mean",
             .method = true},
            &R::majorantScale, number({1, 1000})),
    };
}

void checkRender(const TomlTable& table, R& r) {
    const A& a = r.approximations;
    if (const auto v = table.find("march_estimate"); v && !(a.marchStep > 0))
        throw v->error("needs march_step: tracking takes no steps");
    if (const auto v = table.find("octaves"); v && a.octaves > 0 && a.similarityAfter)
        throw v->error(
            "cannot be used together with similarity_after: octaves have no paths that go on");
}

}  // namespace

template <>
const KeyTable<R>& keysOf() {
    static const KeyTable<R> table{.id = "render",
                                   .where = "[render]",
                                   .keys = joined(amountKeys(), approximationKeys(), effortKeys()),
                                   .check = checkRender,
                                   .outer = "[[surface]]\nsphere = {}\n[render]\n",
                                   .path = "render"};
    return table;
}

}  // namespace woodcock::scene
