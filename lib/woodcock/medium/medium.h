// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <mutex>
#include <optional>
#include <vector>

#include "woodcock/base/affine.h"
#include "woodcock/base/spectrum.h"
#include "woodcock/grid/cell_walk.h"
#include "woodcock/grid/field.h"
#include "woodcock/grid/majorants.h"
#include "woodcock/medium/emission.h"
#include "woodcock/medium/phase.h"

namespace woodcock::grid {
class Motion;
class MovedRanges;
}  // namespace woodcock::grid

namespace woodcock::medium {

/// One additive part of the medium: sigma_t(x) = (absorption + scattering) x f(x) and sigma_s(x) =
/// scattering x f(x) x albedo(x), per world unit and channel, with one phase function. A volume
/// with sigma_a and sigma_s from grids of their own is two parts; overlapping volumes are several:
/// coefficients add.
class MediumPart {
public:
    struct Description {
        std::shared_ptr<const grid::Field> field;   ///< null: f = 1 inside `box`, 0 outside
        Box3d box;                                  ///< of object space; only without a field
        Affine3d worldFromIndex;                    ///< or world from object, without a field
        Rgb absorption{0.0f};                       ///< sigma_a where f (and albedo) is 1
        Rgb scattering{1.0f};                       ///< sigma_s where f (and albedo) is 1
        std::shared_ptr<const grid::Field> albedo;  ///< null: 1; values in [0, 1], 1 or 3 channels
        Affine3d albedoWorldFromIndex;
        PhaseFunction phase = {};
        double majorantScale = 1;      ///< > 1 loosens the majorants; see MajorantGrid::Options
        int majorantSmallestLog2 = 1;  ///< coarsens them
        std::shared_ptr<const grid::Motion> motion = {};  ///< of the field; null: it stands still
        std::shared_ptr<const grid::Motion> albedoMotion = {};  ///< the same motion, of the albedo
    };
    explicit MediumPart(Description description);

    /// The coefficients that a part may change while it keeps field and place.
    struct Coefficients {
        Rgb absorption{0.0f}, scattering{0.0f};
        PhaseFunction phase = {};
        /// sigma_a where the albedo is 0, over `scattering`; see similar_medium.h.
        float loss = 1;
    };
    /// A part with these coefficients. It shares the field and its bounds, whose cells are as fine
    /// as *this* part needed.
    MediumPart with(const Coefficients& coefficients) const;

    const Description& description() const { return d_; }
    const PhaseFunction& phase() const { return d_.phase; }
    /// sigma_t where f is 1; an upper bound where extinctionVaries().
    const Rgb& extinction() const { return extinction_; }
    /// The weight of each channel in a decision for all channels at once; see collide() in
    /// tracking.cpp.
    const Rgb& channelWeight() const { return channelWeight_; }
    const Rgb& absorption() const { return d_.absorption; }
    const Rgb& scattering() const { return d_.scattering; }
    float loss() const { return loss_; }
    /// True where sigma_t depends on the albedo and not on f only. Never true for a part made from
    /// a Description.
    bool extinctionVaries() const { return d_.albedo && loss_ != 1; }
    float largestExtinction() const { return largestExtinction_; }
    /// Bounds of the field where it moves or is moved; null where it stands as its file has it.
    const grid::MovedRanges* moved() const { return moved_.get(); }
    /// False where the field is read at an index position of the part's extent as it is; true where
    /// that has to be placedInField().
    bool readElsewhere() const { return readElsewhere_; }
    /// Takes an index position to where the field is read for it; false where the part is 0 there.
    bool placedInField(Vec3d& index, float time) const;
    const grid::Field* field() const { return d_.field.get(); }
    const grid::Field* albedo() const { return d_.albedo.get(); }
    const grid::MajorantGrid& majorants() const { return *majorants_; }
    /// Cells for ray marching: as large as possible without mixing empty or constant parts with
    /// others. The first thread that asks makes them.
    const grid::MajorantGrid& marchCells() const;

    grid::IndexRay indexRay(Vec3d origin, Vec3d direction) const {
        return {indexFromWorld_.point(origin), indexFromWorld_.vector(direction)};
    }
    /// False only where the ray surely does not meet this part before tMax: a quick test, with a
    /// margin for rounding. `inverse`: one over each component of the direction.
    bool mayMeet(Vec3d origin, Vec3d inverse, double tMax) const {
        double enter = 0, leave = tMax;
        for (int i = 0; i < 3; ++i) {
            const double a = (reach_.lower[i] - origin[i]) * inverse[i];
            const double b = (reach_.upper[i] - origin[i]) * inverse[i];
            enter = std::max(enter, std::min(a, b));  // what is NaN (0 x inf) bounds nothing
            leave = std::min(leave, std::max(a, b));
        }
        return !(leave < enter * (1 - 1e-9));
    }
    Vec3d albedoIndex(Vec3d world) const { return albedoIndexFromWorld_.point(world); }
    /// Index-space box outside which f is the background, at all times.
    const Box3d& support() const { return support_; }
    grid::Range background() const { return background_; }
    /// Index-space box outside which f is 0 although the field has a background; else null. Where
    /// it moves, that is 0 outside of the support.
    const Box3d* limits() const { return limits_ ? &*limits_ : nullptr; }
    /// Index-space box of the part, but for a background without limits.
    const Box3d& extent() const { return limits_ ? *limits_ : support_; }
    bool unbounded() const { return background_.max > 0 && !limits_; }
    Box3d worldBounds() const { return d_.worldFromIndex.box(extent()); }

    /// f, sigma_t and sigma_s at a world position and a time within the shutter, in full: by
    /// trilinear interpolation, or as the field's look-up has it.
    Rgb value(Vec3d world, float time = 0) const;
    Rgb sigmaT(Vec3d world, float time = 0) const;
    Rgb sigmaS(Vec3d world, float time = 0) const;

    /// Roughly the mean of the largest channel's sigma_t over the support, per world unit. It
    /// affects cost only.
    double meanExtinction() const { return meanExtinction_; }

    bool chromatic() const;
    bool scatters() const { return d_.scattering.maximum() > 0; }

private:
    void takeCoefficients();
    Rgb albedo(Vec3d world, float time) const;
    Box3d findReach() const;
    grid::MajorantGrid bounds(const grid::MajorantGrid::Options& options) const;
    double meanOfField() const;

    Description d_;
    float loss_ = 1;
    Rgb extinction_;
    Affine3d indexFromWorld_, albedoIndexFromWorld_;
    Box3d support_;
    std::optional<Box3d> limits_;
    std::shared_ptr<const grid::MovedRanges> moved_;
    bool readElsewhere_ = false;
    Box3d reach_;  // of world space: a little more than where f is not 0
    grid::Range background_;
    float largestExtinction_ = 0;
    Rgb channelWeight_;
    double meanExtinction_ = 0;
    std::shared_ptr<const grid::MajorantGrid> majorants_ = std::make_shared<grid::MajorantGrid>();
    struct Lazy {
        std::once_flag made;
        grid::MajorantGrid cells;
    };
    std::shared_ptr<Lazy> marchCells_ = std::make_shared<Lazy>();  // depend on the field only
};

/// The sum of its parts.
struct Medium {
    std::vector<MediumPart> parts;
    std::vector<EmissionPart> emission = {};

    /// World box of all parts' extents (a background without limits reaches beyond it).
    Box3d worldBounds() const;
    /// Whether anything is not at the same place at all times of the shutter.
    bool moves() const;
};

/// Walks the part of a ray that a medium part fills, as segments of world ray parameter in order:
/// the cells of its field, one segment for a homogeneous box, and the background before and after
/// where that is not zero, as far as the part's limits.
class PartWalk {
public:
    PartWalk(const MediumPart& part, const grid::IndexRay& ray, double tMax)
        : PartWalk(part, part.majorants(), ray, tMax) {}
    PartWalk(const MediumPart& part, const grid::MajorantGrid& cells, const grid::IndexRay& ray,
             double tMax)
        : background_(part.background()),
          homogeneous_(!part.field()),
          end_(tMax),
          enter_(0),
          leave_(tMax),
          cells_(enters(part, ray) && !homogeneous_
                     ? grid::CellWalk(cells, part.support(), ray, enter_, leave_)
                     : grid::CellWalk()) {}

    /// False for segments of the background before and after the support.
    bool insideSupport(const grid::Segment& s) const { return s.t0 >= enter_ && s.t1 <= leave_; }

    bool next(grid::Segment& segment) {
        if (stage_ == Stage::Before) {
            stage_ = Stage::Inside;
            if (background_.max > 0 && enter_ > begin_) {
                segment = {begin_, enter_, background_};
                return true;
            }
        }
        if (stage_ == Stage::Inside) {
            if (homogeneous_) {
                stage_ = Stage::Done;
                if (!(enter_ < leave_)) return false;
                segment = {enter_, leave_, {1, 1}};
                return true;
            }
            if (cells_.next(segment)) return true;
            stage_ = background_.max > 0 && leave_ < end_ ? Stage::After : Stage::Done;
        }
        if (stage_ == Stage::After) {
            stage_ = Stage::Done;
            segment = {leave_, end_, background_};
            return true;
        }
        return false;
    }

private:
    enum class Stage { Before, Inside, After, Done };

    bool enters(const MediumPart& part, const grid::IndexRay& ray) {
        if (part.limits() && !grid::clip(ray, *part.limits(), begin_, end_)) begin_ = end_;
        enter_ = begin_, leave_ = end_;
        if (!part.support().empty() && grid::clip(ray, part.support(), enter_, leave_)) return true;
        enter_ = leave_ = end_;  // all background
        return false;
    }

    grid::Range background_;
    bool homogeneous_;
    Stage stage_ = Stage::Before;
    double begin_ = 0, end_, enter_, leave_;
    grid::CellWalk cells_;
};

}  // namespace woodcock::medium
