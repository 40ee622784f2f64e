// SPDX-License-Identifier: Apache-2.0
#include "woodcock/medium/phase.h"
#include "woodcock/scene/keys/sections.h"
#include "woodcock/scene/keys/values.h"

namespace woodcock::scene {
namespace {

using Base = const std::filesystem::path&;

const std::string outerOfPhase = "[[volume]]\nfile = \"a.vdb\"\n[volume.phase]\n";

template <class D>
KeyTable<D> tableOf(const std::string& type, std::vector<Key<D>> keys, std::string least = {}) {
    return {.id = "phase." + type,
            .where = "a phase function of type " + type,
            .tag = type,
            .keys = std::move(keys),
            .outer = outerOfPhase,
            .least = std::move(least),
            .path = "volume[0].phase"};
}

template <class D>
Key<D> required(std::string name, std::string doc, std::string example, float D::*member) {
    return key({.name = std::move(name),
                .doc = std::move(doc),
                .example = std::move(example),
                .required = true,
                .always = true},
               member, meanCosine());
}

}  // namespace

template <>
const KeyTable<IsotropicPhase>& keysOf() {
    static const auto table = tableOf<IsotropicPhase>("isotropic", {});
    return table;
}

template <>
const KeyTable<HenyeyGreensteinPhase>& keysOf() {
    using P = HenyeyGreensteinPhase;
    static const auto table = tableOf<P>(
        medium::HenyeyGreenstein::name,
        {required<P>("g", "mean cosine, as the key `g` of the volume", "0.5", &P::g)}, "g = 0.1");
    return table;
}

template <>
const KeyTable<TwoLobePhase>& keysOf() {
    using P = TwoLobePhase;
    static const auto table = tableOf<P>(
        medium::TwoLobes::name,
        {required<P>("g", "mean cosine of the first Henyey-Greenstein lobe", "0.8", &P::g),
         required<P>("g2", "that of the second", "-0.3", &P::g2),
         key({.name = "mix",
              .doc = "the part of light that the second scatters",
              .example = "0.2",
              .required = true,
              .always = true},
             &P::mix, number(zeroToOne))},
        "g = 0.7\ng2 = -0.5\nmix = 0.5");
    return table;
}

template <>
const KeyTable<RayleighPhase>& keysOf() {
    static const auto table = tableOf<RayleighPhase>(medium::Rayleigh::name, {});
    return table;
}

template <>
const KeyTable<DrainePhase>& keysOf() {
    using P = DrainePhase;
    static const auto table =
        tableOf<P>(medium::Draine::name,
                   {required<P>("g", "of the Henyey-Greenstein function in it", "0.5", &P::g),
                    key({.name = "alpha",
                         .doc = "how much 1 + alpha cos^2 adds ahead and back. 0 is "
                                "Henyey-Greenstein, 1 Cornette-Shanks",
                         .example = "0.6",
                         .required = true,
                         .always = true},
                        &P::alpha, number(notNegative))},
                   "g = 0.1\nalpha = 2");
    return table;
}

template <>
const KeyTable<MiePhase>& keysOf() {
    using P = MiePhase;
    using Mie = medium::MieDroplets;
    static const auto table = tableOf<P>(
        Mie::name, {key({.name = "diameter",
                         .doc = "of the droplets, in micrometres. Fog has 2 to 20, "
                                "clouds 10 to 40",
                         .comment = "micrometres",
                         .always = true},
                        &P::diameter, number({Mie::smallestDiameter, Mie::largestDiameter}))});
    return table;
}

template <>
const KeyTable<FournierForandPhase>& keysOf() {
    using P = FournierForandPhase;
    static const auto table = tableOf<P>(
        medium::FournierForand::name,
        {key({.name = "ior",
              .doc = "refractive index of the particles relative to the water. Plankton has 1.02 "
                     "to 1.1, minerals 1.15 to 1.2",
              .always = true},
             &P::ior,
             number({.lower = 1, .upper = medium::FournierForand::largestIor, .strict = true})),
         key({.name = "backscatter",
              .doc = "the part of light that turns by more than 90 degrees. Sea water has some "
                     "0.005 to 0.03",
              .always = true},
             &P::backscatter, number({.lower = 0, .upper = 0.5, .strict = true}))});
    return table;
}

template <>
const KeyTable<TablePhase>& keysOf() {
    using P = TablePhase;
    static const auto table = tableOf<P>(
        medium::PhaseTable::name,
        {key({.name = "file",
              .doc = "a text file with a row for each cosine, rising from -1 to 1: the cosine and "
                     "the density per steradian, or one for each of red, green and blue",
              .example = "\"haze.txt\"",
              .required = true,
              .always = true},
             &P::file, path()),
         key({.name = "normalise",
              .doc = "divides the densities by their integral. Otherwise it must be 1, to one part "
                     "in a thousand"},
             &P::normalise, flag())},
        "file = \"cloud.txt\"");
    return table;
}

Value<PhaseDescription> phaseFunction() {
    return {"`{ type, .. }`",
            {"{ type = \"rayleigh\" }", "{ type = \"mie\", diameter = 7 }"},
            [](const TomlValue& value, Base base) {
                PhaseDescription phase;
                readTagged(value.table(), "phase function type", phase, base);
                return phase;
            },
            [](const PhaseDescription& phase, const SceneWriter& out) {
                std::string text = "{ type = " + tomlText(tagOf(phase));
                std::visit(
                    [&](const auto& kind) {
                        forWritten(kind, out, [&](const KeyInfo& info, const Written& written) {
                            text += ", " + info.name + " = " + written.value;
                        });
                    },
                    phase);
                return text + " }";
            },
            [](PhaseDescription& phase, Files& files) {
                std::visit([&](auto& kind) { addFiles(kind, files); }, phase);
            }};
}

}  // namespace woodcock::scene
