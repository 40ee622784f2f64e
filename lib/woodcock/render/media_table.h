// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "woodcock/base/random.h"
#include "woodcock/render/approximate_media.h"
#include "woodcock/render/flight.h"
#include "woodcock/render/needs.h"

namespace woodcock::render {

/// The mean optical depth along the diagonal of a medium's box.
double depthAcross(const MediumSummary& medium);

/// Whether paths in a medium are long, as that tells.
bool isThick(const MediumSummary& medium);

/// Whether they are, and a single next event is noisy as the phase function has a peak: see
/// several_events.h. Elsewhere several events cost more than they bring.
bool thickAndPeaked(const MediumSummary& medium);

/// The media of a scene by number. They come in sets, each of as many: first the scene's own,
/// outside and then what surfaces hold; then those that approximations use in their place. Paths
/// and shadow rays carry the number of a set. 0 is the scene's own.
class MediaTable {
public:
    /// `approximate` may be null. Both outlive this.
    MediaTable(const Scene& scene, const Needs& needs, const Approximations& approximations,
               const ApproximateMedia* approximate);

    const MediumSummary& operator[](std::uint32_t number) const { return media_[number]; }
    /// The number of a set's medium: 0 outside, then Scene::interiorMedia.
    std::uint32_t number(std::uint8_t set, std::uint32_t medium) const {
        return set * setSize_ + medium;
    }

    /// The set for a path that has scattered so often.
    std::uint8_t setAfter(std::int64_t scatterings) const {
        return similarityAfter_ && scatterings >= *similarityAfter_ ? 1 : 0;
    }
    /// How a path goes on after its next scattering: through which set of media, and with the
    /// scattered light times `amount`.
    struct Onward {
        std::uint8_t mediumSet;
        double amount = 1;
    };
    /// With octaves, draws one in proportion to its amount. Light of octave i is a^i x sigma_s x
    /// phase(c^i g) x transmittance of b^i sigma_t. It is found by next-event estimation and by the
    /// following flight, which ends where it leaves the medium.
    Onward onward(std::int64_t scatterings, RandomStream& random) const;

    /// The set of media that a path goes on through has the phase functions of the scattering
    /// before. Else the medium that scatters has them.
    bool phasesOfSetOnward() const { return octaves_ > 0; }
    /// There are sets beside the scene's own.
    bool replaces() const { return replaces_; }
    /// Octaves end with next-event estimation: their flights meet no light.
    bool octavesEnd() const { return octavesEnd_; }

private:
    std::vector<MediumSummary> media_;  // set by set
    std::uint32_t setSize_ = 1;
    std::optional<int> similarityAfter_;
    int octaves_ = 0;
    bool replaces_ = false, octavesEnd_ = false;
};

}  // namespace woodcock::render
