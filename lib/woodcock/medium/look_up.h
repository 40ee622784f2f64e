// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <memory>

#include "woodcock/grid/motion.h"
#include "woodcock/medium/medium.h"

namespace woodcock::medium {

// A part of the medium at (position, time). Tracking, marching, emission, equiangular points and
// layers all ask here.
//
// Time is that of the path, from 0 to 1 within the shutter. Index positions of a part whose
// transform moves are those of that time: see MediumPart::indexRay(). A part that moves by
// velocities is read where its matter was at the time of its file: see grid::Motion.

/// How a field is read: one voxel, chosen at random by the weights of the interpolation. For values
/// that enter linearly: the noise then causes no bias.
struct OneTap {
    std::uint64_t bits;
};
/// How a field is read: by its interpolation, in full.
struct InFull {};

/// A field at an index position in its support. One channel serves all N.
template <int N>
[[gnu::always_inline]] inline Spectrum<N> read(const grid::Field& field, Vec3d index, OneTap how) {
    const Vec3i v = field.stochasticVoxel(index, how.bits);
    if (N == 1 || field.channels() == 1) return Spectrum<N>(field.voxel(v));
    return Spectrum<N>::map([&](int c) { return field.voxel(v, c); });
}
template <int N>
Spectrum<N> read(const grid::Field& field, Vec3d index, InFull) {
    if (N == 1 || field.channels() == 1) return Spectrum<N>(field.trilinear(index));
    const std::array<float, N> values = field.interpolated<N>(index);
    return Spectrum<N>::map([&](int c) { return values[static_cast<std::size_t>(c)]; });
}

/// densityAt() of a part that is read elsewhere. Not inline: the other parts have more registers
/// without it.
template <int N, class How>
[[gnu::noinline]] Spectrum<N> densityElsewhere(const MediumPart& part, Vec3d index, float time,
                                               How how) {
    if (!part.placedInField(index, time)) return Spectrum<N>(0.0f);
    return read<N>(*part.field(), index, how);
}

/// f of a part that has a field, at an index position within the part's extent.
template <int N, class How>
[[gnu::always_inline]] inline Spectrum<N> densityAt(const MediumPart& part, Vec3d index, float time,
                                                    How how) {
    if (part.readElsewhere()) [[unlikely]]
        return densityElsewhere<N>(part, index, time, how);
    return read<N>(*part.field(), index, how);
}

/// The albedo of a part that has a grid of it.
template <int N, class How>
[[gnu::always_inline]] inline Spectrum<N> albedoAt(const MediumPart& part, Vec3d world, float time,
                                                   How how) {
    const grid::Field& field = *part.albedo();
    Vec3d index = part.albedoIndex(world, time);
    if (const auto& motion = part.description().albedoMotion) [[unlikely]]
        index = motion->source(index, time);
    return read<N>(field, field.nearSupport(index), how);
}

/// What a part emits where its field, scaled by Description::scale, does: the field at an index
/// position within the part's extent.
inline Rgb glowAt(const EmissionPart& part, Vec3d index, float time) {
    const grid::Field& field = *part.description().field;
    if (const auto& motion = part.description().motion) [[unlikely]] {
        index = motion->source(index, time);
        if (field.limits() && !field.limits()->contains(index)) return {};
    }
    return read<3>(field, field.nearSupport(index), InFull{});
}

/// Whether anything of a medium is not at the same place at all times of the shutter.
inline bool moves(const Medium& medium) {
    const auto does = [](const std::shared_ptr<const grid::Motion>& motion) {
        return motion && motion->moves();
    };
    return std::ranges::any_of(medium.parts,
                               [&](const MediumPart& part) {
                                   const MediumPart::Description& d = part.description();
                                   return d.movement || does(d.motion) || does(d.albedoMotion);
                               }) ||
           std::ranges::any_of(medium.emission, [&](const EmissionPart& part) {
               return part.description().movement || does(part.description().motion);
           });
}

}  // namespace woodcock::medium
