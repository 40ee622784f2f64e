// SPDX-License-Identifier: Apache-2.0
#include "woodcock/medium/medium.h"

#include "woodcock/base/error.h"
#include "woodcock/base/random.h"
#include "woodcock/grid/moved_ranges.h"
#include "woodcock/medium/look_up.h"

namespace woodcock::medium {

MediumPart::MediumPart(Description description) : d_(std::move(description)) {
    const double determinant = d_.worldFromIndex.determinant();
    if (!std::isfinite(determinant) || determinant == 0)
        throw inputError("a volume's transform is singular: its determinant is {}", determinant);
    indexFromWorld_ = d_.worldFromIndex.inverse();
    albedoIndexFromWorld_ = d_.albedoWorldFromIndex.inverse();
    takeCoefficients();
    if (d_.motion && d_.field) {
        moved_ = std::make_shared<grid::MovedRanges>(d_.field, d_.motion);
        support_ = moved_->support();
        background_ = moved_->outside();
    } else if (d_.field) {
        support_ = d_.field->support();
        limits_ = d_.field->limits();
        background_ = d_.field->storedRange(d_.field->blocks().outside());
    } else {
        support_ = d_.box;
    }
    readElsewhere_ = moved_ || unbounded();
    reach_ = findReach();
    if (!d_.field) {
        meanExtinction_ = largestExtinction_;
        return;
    }
    const double voxelWidth = std::cbrt(std::abs(determinant));
    majorants_ = std::make_shared<grid::MajorantGrid>(
        bounds({largestExtinction_ * voxelWidth, d_.majorantScale, d_.majorantSmallestLog2}));
    meanExtinction_ = meanOfField() * double{largestExtinction_};
}

grid::MajorantGrid MediumPart::bounds(const grid::MajorantGrid::Options& options) const {
    if (!moved_) return {*d_.field, options};
    return {moved_->blocks(), [&](Vec3i block) { return moved_->finest(block); }, options};
}

double MediumPart::meanOfField() const {
    const Box3d& box = extent();
    if (box.empty()) return 0;
    RandomStream random(hashOf(0x6d65616e));
    constexpr int samples = 4096;
    double mean = 0;
    for (int i = 0; i < samples; ++i) {
        const Vec3d u{random.uniform(), random.uniform(), random.uniform()};
        Vec3d index = box.lower + box.size() * u;
        const std::uint64_t bits = random.bits();
        const auto time = static_cast<float>((i + 0.5) / samples);
        if (moved_ && !placedInField(index, time)) continue;
        mean += double{d_.field->stochastic(index, bits)} / samples;
    }
    return mean;
}

bool MediumPart::placedInField(Vec3d& index, float time) const {
    if (d_.motion) {
        index = d_.motion->source(index, time);
        if (const auto& limits = d_.field->limits(); limits && !limits->contains(index))
            return false;
    }
    index = d_.field->nearSupport(index);
    return true;
}

const grid::MajorantGrid& MediumPart::marchCells() const {
    std::call_once(marchCells_->made, [this] {
        if (!d_.field || !(d_.field->range().max > 0)) return;
        // As if the optical depth were huge: then no cells that differ are merged.
        const double deep = 1e9 / d_.field->range().max;
        marchCells_->cells = bounds({deep, 1, grid::blockLog2});
    });
    return marchCells_->cells;
}

void MediumPart::takeCoefficients() {
    extinction_ = d_.absorption + d_.scattering * (d_.albedo ? std::max(1.0f, loss_) : 1.0f);
    for (int c = 0; c < 3; ++c)
        if (!(d_.scattering[c] >= 0 && d_.absorption[c] >= 0 && std::isfinite(extinction()[c])))
            throw inputError("sigma_a is {} and sigma_s is {}; expected finite numbers >= 0",
                             d_.absorption[c], d_.scattering[c]);
    largestExtinction_ = extinction().maximum();
    channelWeight_ = Rgb::map([&](int c) {
        const float sigmaT = extinction()[c];
        const float albedo =
            sigmaT > 0 ? d_.scattering[c] / sigmaT : 1;  // in vacuum nothing is absorbed
        return 0.05f + albedo * albedo;
    });
}

MediumPart MediumPart::with(const Coefficients& coefficients) const {
    MediumPart part = *this;
    part.d_.absorption = coefficients.absorption;
    part.d_.scattering = coefficients.scattering;
    part.d_.phase = coefficients.phase;
    part.loss_ = coefficients.loss;
    part.takeCoefficients();
    if (largestExtinction_ > 0)
        part.meanExtinction_ *= part.largestExtinction_ / largestExtinction_;
    return part;
}

Box3d MediumPart::findReach() const {
    constexpr double infinity = std::numeric_limits<double>::infinity();
    const Vec3d everywhere{infinity, infinity, infinity};
    if (unbounded() || extent().empty()) return {-everywhere, everywhere};
    const Box3d box = worldBounds();
    const Vec3d far = max(max(box.lower, -box.lower), max(box.upper, -box.upper));
    const double margin = 1e-9 * std::max({far.x, far.y, far.z});
    const Vec3d more{margin, margin, margin};
    return {box.lower - more, box.upper + more};
}

Rgb MediumPart::value(Vec3d world, float time) const {
    const Vec3d p = indexFromWorld_.point(world);
    if (!d_.field) return Rgb(support_.contains(p) ? 1.0f : 0.0f);
    if (limits_ && !limits_->contains(p)) return {};
    return densityAt<3>(*this, moved_ ? p : d_.field->nearSupport(p), time, InFull{});
}

Rgb MediumPart::albedo(Vec3d world, float time) const {
    return d_.albedo ? albedoAt<3>(*this, world, time, InFull{}) : Rgb(1.0f);
}

Rgb MediumPart::sigmaT(Vec3d world, float time) const {
    const Rgb f = value(world, time);
    if (!extinctionVaries()) return extinction() * f;
    const Rgb a = albedo(world, time);
    return Rgb::map([&](int c) {
        return (d_.absorption[c] + d_.scattering[c] * (a[c] + loss_ * (1 - a[c]))) * f[c];
    });
}

Rgb MediumPart::sigmaS(Vec3d world, float time) const {
    return d_.scattering * value(world, time) * albedo(world, time);
}

bool MediumPart::chromatic() const {
    return !isGrey(d_.absorption) || !isGrey(d_.scattering) ||
           (scatters() && d_.phase.chromatic()) || (d_.field && d_.field->channels() == 3) ||
           (d_.albedo && d_.albedo->channels() == 3);
}

bool Medium::moves() const {
    const auto does = [](const std::shared_ptr<const grid::Motion>& motion) {
        return motion && motion->moves();
    };
    for (const MediumPart& p : parts)
        if (does(p.description().motion) || does(p.description().albedoMotion)) return true;
    for (const EmissionPart& p : emission)
        if (does(p.description().motion)) return true;
    return false;
}

Box3d Medium::worldBounds() const {
    Box3d box;
    for (const MediumPart& p : parts)
        if (!p.extent().empty()) box.add(p.worldBounds());
    return box;
}

}  // namespace woodcock::medium
