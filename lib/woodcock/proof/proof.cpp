// SPDX-License-Identifier: Apache-2.0
#include "woodcock/proof/proof.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "woodcock/base/random.h"
#include "woodcock/proof/checks/subjects.h"
#include "woodcock/proof/support/render_scene.h"

namespace woodcock::proof {

const char* nameOf(Kind kind) {
    switch (kind) {
        case Kind::ClosedForm:
            return "closed form";
        case Kind::Slab:
            return "slab";
        case Kind::Surface:
            return "surface";
        case Kind::Property:
            return "property";
        case Kind::Sampling:
            return "sampling";
        case Kind::Extreme:
            return "extreme";
    }
    return "";
}

const char* nameOf(Verdict verdict) {
    switch (verdict) {
        case Verdict::Pass:
            return "pass";
        case Verdict::Fail:
            return "FAIL";
        case Verdict::Imprecise:
            return "imprecise";
    }
    return "";
}

double Case::z() const {
    constexpr double infinity = std::numeric_limits<double>::infinity();
    const double difference = measured - expected;
    if (!std::isfinite(difference) || !std::isfinite(standardError)) return infinity;
    const double excess = std::max(0.0, std::abs(difference) - allowance);
    if (excess == 0) return 0;
    return std::copysign(standardError > 0 ? excess / standardError : infinity, difference);
}

Verdict Case::verdict() const {
    if (!(std::abs(z()) <= largestZ)) return Verdict::Fail;
    return standardError <= largestError ? Verdict::Pass : Verdict::Imprecise;
}

void Lab::stopIfAsked() const {
    if (options_.stop && options_.stop()) throw Stopped{};
}

void Lab::add(Case c) {
    cases_.push_back(std::move(c));
    stopIfAsked();
}

std::uint64_t Lab::seed(const std::string& name) const {
    stopIfAsked();
    std::uint64_t h = options_.seed;
    for (const char c : name) h = hashOf(h, static_cast<unsigned char>(c));
    return h;
}

const std::vector<Check>& checks() {
    static const std::vector<Check> all = [] {
        std::vector<Check> list;
        for (const auto& subject :
             {closedForms(),      singleScattering(), slabs(),       surfaces(),
              surfacesTogether(), roughSurfaces(),    properties(),  sampling(),
              phaseFunctions(),   lightSampling(),    aimedPoints(), flatLights(),
              lampsInFog(),       lightDepths(),      lanes(),       skies(),
              extremes(),         emission(),         motion(),      motionOfTransforms(),
              motionOfLights()})
            list.insert(list.end(), subject.begin(), subject.end());
        std::stable_sort(list.begin(), list.end(),
                         [](const Check& a, const Check& b) { return a.kind < b.kind; });
        return list;
    }();
    return all;
}

std::vector<Case> run(const Check& check, const Options& options) {
    Lab lab(options);
    sampleAdaptively(options.adaptive);
    std::optional<Case> failure;
    try {
        check.run(lab);
    } catch (const Stopped&) {
        // The cases so far are valid.
    } catch (const std::exception& error) {
        failure = {.name = std::string(check.name) + ", to its end",
                   .expected = 1,
                   .measured = 0,
                   .note = error.what()};
    }
    std::vector<Case> cases = lab.takeCases();
    if (failure) cases.push_back(*failure);
    for (Case& c : cases) c.kind = check.kind;
    return cases;
}

}  // namespace woodcock::proof
