// SPDX-License-Identifier: Apache-2.0
// Compiled once for each set of instructions: see trace_lanes.cpp.
#if defined(WOODCOCK_LANE_EMISSION) == defined(HWY_TARGET_TOGGLE)
#ifdef WOODCOCK_LANE_EMISSION
#undef WOODCOCK_LANE_EMISSION
#else
#define WOODCOCK_LANE_EMISSION
#endif

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <vector>

#include "woodcock/medium/look_up.h"
#include "woodcock/medium/optical_depth.h"
#include "woodcock/render/batch.h"
#include "woodcock/render/lanes/lane_depths-inl.h"
#include "woodcock/render/lanes/lane_rows-inl.h"
#include "woodcock/render/lanes/lane_scene.h"
#include "woodcock/render/stages/camera_stops.h"
#include "woodcock/render/stages/light.h"

HWY_BEFORE_NAMESPACE();
namespace woodcock::render::HWY_NAMESPACE {

/// Where rays start that look for what glows: at the camera, or where a path has scattered.
template <int N>
struct EmissionVertex {
    std::uint32_t path;
    std::uint8_t set;          ///< of media
    image::LightKind kind;     ///< as layers have the light
    Vec3d position;            ///< in the world
    Vec3d direction;           ///< of the path before; of the camera's ray
    const LanePart* scatters;  ///< the part whose phase function turns the rays; null: the camera's
    Spectrum<N> throughput;
    Spectrum<N> correction{1.0f};  ///< of the camera's ray: see LaneTracer::endPoint()
    std::uint64_t key;             ///< of random numbers
    std::array<double, 2> u;  ///< in [0, 1): of the rays' directions; of the camera's first tooth
    std::array<double, 2> raster;  ///< of the camera's ray, in pixels
    int rays = 1;
    std::optional<PlanarDepth> depth = {};  ///< of points on a camera ray, where it is asked for
};

/// Brings the light of what glows along rays, a ray in each lane; N: tracked channels.
///
/// What glows adds to a ray the integral of T q: of the emission and the transmittance to it. It is
/// read at the teeth of a comb, whose distances are even in the integral of EmissionLattice::glow,
/// g, behind a random start; each brings T q / g times their distance. Points in proportion to a
/// bound of q: Villemin and Hery 2013, "Practical Illumination from Flames". Several along the way:
/// Simon et al. 2017, "Line Integration for Rendering Heterogeneous Emissive Volumes".
///
/// T is estimated by residual ratio tracking (Novak et al. 2014, equation 17), by one walk for all
/// teeth. Nothing is decided on the way, so what is behind a collision still counts. Of a camera's
/// ray the CameraDepths tell T, where there are some, with rare exact corrections as in
/// correctedTransmittance().
///
/// A camera's ray first finds the integral of g along its way, which makes its teeth as many as
/// `teethOfCamera` wherever something glows. Other rays have teeth at the same distance anywhere:
/// most where most light comes from.
template <int N>
class EmissionTracer {
public:
    EmissionTracer(const LaneScene& scene, Batch<N, false>& batch) : scene_(scene), batch_(batch) {}

    void add(const EmissionVertex<N>& vertex) {
        for (int i = 0; i < vertex.rays; ++i)
            rays_.push_back({.vertex = static_cast<std::uint32_t>(vertices_.size()),
                             .number = static_cast<std::uint32_t>(i)});
        vertices_.push_back(vertex);
    }

    /// Traces all rays. Their light comes to the paths in the order in which they were added.
    void run() {
        for (std::size_t i = 0; i < rays_.size(); i += laneCount) aim(i);
        for (std::size_t lane = 0; lane < laneCount; ++lane) nextRay(lane);
        while (!hn::AllTrue(lanesF, whoIs(Idle))) {
            step();
            meetEvents();
        }
        for (const Ray& ray : rays_) handIn(ray);
        batch_.counters.shadowRays += rays_.size();
        vertices_.clear(), rays_.clear(), nextRay_ = 0;
    }

private:
    static constexpr float far = 1e30f;
    /// Of 2 to 6, this measured best, with correctionsOfGlow as it is.
    static constexpr int teethOfCamera = 6;
    /// Cameras' rays to what glows are corrected so much more often than those that scatter: all of
    /// their light has the error. Of 1 to 8, 2 to 8 measured alike.
    static constexpr float correctionsOfGlow = 3;
    /// Other rays have their teeth at this distance, as a multiple of
    /// EmissionLattice::typicalGlow(). Of 0.15 to 2, 0.4 to 0.8 measured best.
    static constexpr float spacingOfOthers = 0.6f;

    /// What a lane does.
    enum Way : std::int32_t { Idle, Measuring, Gathering };

    struct Ray {
        std::uint32_t vertex, number;
        std::array<float, 3> direction{};  // in the world
        Rgb weight{1.0f}, light{};
    };

    /// The optical depth along a camera's ray.
    struct KnownDepth {
        DepthsAhead<N> ahead;
        float correction = 0;  // one over their chance; 0: it is not corrected
        Rgb exact{};           // of what is integrated exactly,
        double exactTo = 0;    // up to this distance

        explicit KnownDepth(const DepthsAhead<N>& a) : ahead(a) {}
    };

    Mask whoIs(Way w) const { return hn::RebindMask(lanesF, way_.get() == hn::Set(lanesI, w)); }
    const EmissionVertex<N>& vertexOf(const Ray& ray) const { return vertices_[ray.vertex]; }

    // ---- where rays go

    /// Draws the directions of as many rays as there are lanes, from `first` on.
    void aim(std::size_t first) {
        const std::size_t count = std::min(laneCount, rays_.size() - first);
        Floats v[3]{}, g{}, u[2]{};
        for (std::size_t i = 0; i < count; ++i) {
            const Ray& ray = rays_[first + i];
            const EmissionVertex<N>& vertex = vertexOf(ray);
            for (int k = 0; k < 3; ++k) v[k][i] = static_cast<float>(vertex.direction[k]);
            g[i] = vertex.scatters ? vertex.scatters->g : 0;
            // The rays of a vertex are the points of a lattice of the golden ratio, moved.
            constexpr double golden = 0.61803398874989485;
            const double along = (ray.number + vertex.u[0]) / vertex.rays;
            const double around = ray.number * golden + vertex.u[1];
            const auto belowOne = [](double x) {
                return std::min(static_cast<float>(x), 0x1.fffffep-1f);
            };
            u[0][i] = belowOne(along), u[1][i] = belowOne(around - std::floor(around));
        }
        F density;
        const V3 turned = sampleHenyeyGreenstein({v[0].get(), v[1].get(), v[2].get()}, g.get(),
                                                 u[0].get(), u[1].get(), density);
        Floats w[3];
        w[0].set(turned.x), w[1].set(turned.y), w[2].set(turned.z);
        for (std::size_t i = 0; i < count; ++i) {
            Ray& ray = rays_[first + i];
            const LanePart* scatters = vertexOf(ray).scatters;
            for (std::size_t k = 0; k < 3; ++k) ray.direction[k] = scatters ? w[k][i] : v[k][i];
            if (scatters && !scatters->henyeyGreenstein)
                turn(ray, double{u[0][i]}, double{u[1][i]});
        }
    }

    /// Draws a direction by another phase function.
    void turn(Ray& ray, double u0, double u1) {
        const EmissionVertex<N>& vertex = vertexOf(ray);
        const medium::PhaseFunction& phase = vertex.scatters->part->phase();
        Vec3d turned;
        if (N == 3 && phase.chromatic()) {
            const Rgb throughput = toRgb(vertex.throughput);
            turned = phase.sampleMixed(vertex.direction, throughput, u0, u1).direction;
            ray.weight = phase.mixed(dot(vertex.direction, turned), throughput).weight;
        } else {
            turned = phase.sample(vertex.direction, u0, u1).direction;
        }
        for (int k = 0; k < 3; ++k)
            ray.direction[static_cast<std::size_t>(k)] = static_cast<float>(turned[k]);
    }

    // ---- the walk

    /// Gives a lane the next ray that meets the lattice.
    void nextRay(std::size_t lane) {
        way_[lane] = Idle;
        while (way_[lane] == Idle && nextRay_ < rays_.size()) {
            ray_[lane] = nextRay_++;
            enter(lane);
        }
    }

    /// Puts a lane to where its ray enters the lattice, if it does.
    void enter(std::size_t lane) {
        const Ray& ray = rays_[ray_[lane]];
        const EmissionVertex<N>& vertex = vertexOf(ray);
        const EmissionLattice& lattice = scene_.emission[vertex.set];
        const Vec3d direction{double{ray.direction[0]}, double{ray.direction[1]},
                              double{ray.direction[2]}};
        const grid::IndexRay along{lattice.latticeFromWorld().point(vertex.position),
                                   lattice.latticeFromWorld().vector(direction)};
        double t0 = 0, t1 = std::numeric_limits<double>::infinity();
        if (!grid::clip(along, lattice.box(), t0, t1)) return;
        const Vec3d at = along.at(t0);
        const double edge = lattice.edge();
        lattice_[lane] = &lattice, content_[lane] = lattice.content().data();
        edge_[lane] = static_cast<float>(edge), entry_[lane] = t0;
        for (int i = 0; i < 3; ++i) {
            const int cell = std::clamp(static_cast<int>(at[i] / edge), 0, lattice.cells()[i] - 1);
            first_[i][lane] = cell, cells_[i][lane] = lattice.cells()[i];
            firstU_[i][lane] =
                std::clamp(static_cast<float>(at[i] - cell * edge), 0.0f, edge_[lane]);
            d_[i][lane] = static_cast<float>(along.direction[i]);
            inverse_[i][lane] = 1 / std::max(std::abs(d_[i][lane]), 1 / far);
        }
        if (vertex.scatters) {
            gather(lane, lattice.typicalGlow() * spacingOfOthers, std::numeric_limits<int>::max());
        } else {
            way_[lane] = Measuring, found_[lane] = 0;
            start(lane);
        }
    }

    void start(std::size_t lane) {
        for (int i = 0; i < 3; ++i)
            cell_[i][lane] = first_[i][lane], u_[i][lane] = firstU_[i][lane];
        t_[lane] = 0;
        load(lane, (cell_[2][lane] * cells_[1][lane] + cell_[1][lane]) * cells_[0][lane] +
                       cell_[0][lane]);
    }

    /// Has a lane gather light along its ray.
    void gather(std::size_t lane, float spacing, int teeth) {
        const Ray& ray = rays_[ray_[lane]];
        const EmissionVertex<N>& vertex = vertexOf(ray);
        RandomStream random(vertex.key + ray.number);
        const std::uint64_t key = random.bits();
        key_[0][lane] = static_cast<std::uint32_t>(key);
        key_[1][lane] = static_cast<std::uint32_t>(key >> 32);
        count_[lane] = 0, spacing_[lane] = spacing, teeth_[lane] = teeth;
        const double first = vertex.scatters ? random.uniform() : vertex.u[0];
        toTooth_[lane] = spacing * static_cast<float>(first);
        toCollision_[lane] = static_cast<float>(-std::log(random.uniformOpenLow()));
        for (int c = 0; c < channels_; ++c) passes_[c][lane] = 1, depth_[c][lane] = 0;
        known_[lane].reset();
        if (!vertex.scatters && vertex.set == 0 && scene_.cameraDepths) {
            const CameraDepths& depths = *scene_.cameraDepths;
            KnownDepth& known = known_[lane].emplace(DepthsAhead<N>(
                depths, depths.at(vertex.raster[0], vertex.raster[1]), scene_.parts.data()));
            const float chance =
                std::min(1.0f, correctionsOfGlow * known.ahead.correctionChance(depths.steps()));
            if (random.uniform() < double{chance}) known.correction = 1 / chance;
            toCollision_[lane] = far;  // nothing is to be tracked
        }
        way_[lane] = Gathering;
        start(lane);
    }

    /// Reads what is known of a lane's cell.
    void load(std::size_t lane, std::int32_t number) {
        const EmissionLattice::Cell& cell = content_[lane][number];
        residual_[lane] = cell.residual, perResidual_[lane] = cell.perResidual;
        glow_[lane] = cell.glow, perGlow_[lane] = cell.perGlow;
        extinction_[0][lane] = cell.extinction[0];
        for (int c = 1; c < channels_; ++c) extinction_[c][lane] = cell.extinction[c];
    }

    /// Lanes go on to the next face of their cell, tentative collision or tooth.
    HWY_INLINE void step() {
        const Mask measuring = whoIs(Measuring), gathering = whoIs(Gathering);
        const F zero = hn::Zero(lanesF), edge = edge_.get(), glow = glow_.get();
        F face[3];
        for (int i = 0; i < 3; ++i) {
            const F u = u_[i].get();
            face[i] = hn::IfThenElse(d_[i].get() >= zero, edge - u, u) * inverse_[i].get();
        }
        const F toFace = hn::Min(face[0], hn::Min(face[1], face[2]));
        const F toCollision = toCollision_.get() * perResidual_.get();
        const F toTooth = toTooth_.get() * perGlow_.get();
        const F toEvent = hn::Min(toCollision, toTooth);
        const Mask meets = hn::And(gathering, toEvent < toFace);
        const F length = hn::Max(zero, hn::IfThenElse(meets, toEvent, toFace));
        for (int i = 0; i < 3; ++i)
            u_[i].set(hn::Max(zero, hn::Min(edge, u_[i].get() + d_[i].get() * length)));
        t_.set(t_.get() + length);
        toCollision_.set(hn::Max(zero, toCollision_.get() - length * residual_.get()));
        toTooth_.set(hn::Max(zero, toTooth_.get() - length * glow));
        found_.set(found_.get() + length * glow);
        for (int c = 0; c < channels_; ++c)
            depth_[c].set(depth_[c].get() + extinction_[c].get() * length);
        colliding_ = bitsOf(hn::And(meets, toCollision <= toTooth));
        atTooth_ = bitsOf(meets) & ~colliding_;
        const Mask alongX = face[0] == toFace, alongY = hn::AndNot(alongX, face[1] == toFace);
        cross(hn::AndNot(meets, hn::Or(measuring, gathering)),
              {alongX, alongY, hn::Not(hn::Or(alongX, alongY))});
    }

    /// Lanes that have come to a face enter the next cell, or leave the lattice.
    HWY_INLINE void cross(Mask crossing, const std::array<Mask, 3>& along) {
        const I zero = hn::Zero(lanesI), one = hn::Set(lanesI, 1);
        I room = one;  // negative outside
        for (std::size_t i = 0; i < 3; ++i) {
            const Mask through = hn::And(crossing, along[i]);
            const Mask forward = d_[i].get() >= hn::Zero(lanesF);
            const I next = cell_[i].get() + hn::IfThenElse(ofInts(forward), one, zero - one);
            cell_[i].set(ofInts(through), next);
            u_[i].set(through, hn::IfThenElse(forward, hn::Zero(lanesF), edge_.get()));
            const I cell = cell_[i].get();
            room = hn::Min(room, hn::Min(cell, cells_[i].get() - one - cell));
        }
        const Mask outside = hn::RebindMask(lanesF, room < zero);
        const std::uint32_t leaving = bitsOf(hn::And(crossing, outside));
        const std::uint32_t entering = bitsOf(crossing) & ~leaving;
        batch_.counters.shadowSegments += static_cast<unsigned>(std::popcount(entering));
        Ints number;
        number.set((cell_[2].get() * cells_[1].get() + cell_[1].get()) * cells_[0].get() +
                   cell_[0].get());
        forEachLane(entering, [&](std::size_t i) { load(i, number[i]); });
        forEachLane(leaving, [&](std::size_t i) {
            if (way_[i] == Measuring && found_[i] > 0)
                gather(i, found_[i] / teethOfCamera, teethOfCamera);
            else
                nextRay(i);
        });
    }

    // ---- what happens on the way

    HWY_INLINE void meetEvents() {
        if (!(colliding_ | atTooth_)) return;
        const U zero = hn::Zero(lanesU);
        const U key[4] = {key_[0].get(), key_[1].get(), zero, zero};
        const U counter[4] = {count_.get(), zero, zero, zero};
        U words[4];
        threefry(key, counter, words);
        const Mask meeting = maskOf(colliding_ | atTooth_);
        count_.set(hn::RebindMask(lanesU, meeting), count_.get() + hn::Set(lanesU, 1));
        Row<std::uint32_t> bits[2];
        bits[0].set(words[0]), bits[1].set(words[1]);
        Floats next, chance, passes[N];
        next.set(drawDepth(words[2])), chance.set(uniform(words[3]));
        for (int c = 0; c < channels_; ++c)
            passes[c].set(passes_[c].get() * decay(depth_[c].get()));
        const auto tapOf = [&](std::size_t i) {
            return medium::OneTap{std::uint64_t{bits[1][i]} << 32 | bits[0][i]};
        };
        const auto passesOf = [&](std::size_t i) {
            return Spectrum<N>::map([&](int c) { return passes[channels_ == 1 ? 0 : c][i]; });
        };
        forEachLane(colliding_, [&](std::size_t i) {
            toCollision_[i] = next[i];
            collide(i, tapOf(i), passesOf(i).maximum(), chance[i]);
        });
        forEachLane(atTooth_, [&](std::size_t i) { readTooth(i, passesOf(i)); });
    }

    Vec3d positionOf(std::size_t lane) {
        Vec3d at;
        for (int i = 0; i < 3; ++i)
            at[i] = double{edge_[lane]} * cell_[i][lane] + double{u_[i][lane]};
        return at;
    }

    /// A tentative collision of the residual, of light of which `passes` has come so far.
    void collide(std::size_t lane, medium::OneTap tap, float passes, float chance) {
        const Vec3d at = positionOf(lane);
        Spectrum<N> sigma(0.0f);
        for (const EmissionLattice::Source& source : lattice_[lane]->extinction())
            sigma +=
                medium::read<N>(*source.field, source.index(at), tap) * channels<N>(source.scale);
        for (int c = 0; c < channels_; ++c)
            passes_[c][lane] *= 1 - (sigma[c] - extinction_[c][lane]) * perResidual_[lane];
        // Little comes from behind thick media: Russian roulette.
        constexpr float little = 0.01f;
        if (passes >= little) return;
        if (chance * little >= passes) {
            nextRay(lane);
            return;
        }
        for (int c = 0; c < channels_; ++c) passes_[c][lane] *= little / passes;
    }

    /// The transmittance of a camera's ray up to a distance from the camera.
    Spectrum<N> passesFromCamera(KnownDepth& known, const EmissionVertex<N>& vertex, double t) {
        Spectrum<N> passes = transmittanceOf<N>(known.ahead.at(t).depth);
        if (!(known.correction > 0)) return passes;
        known.exact += medium::exactOpticalDepth(scene_.traced.mediumOfSet(0), vertex.position,
                                                 vertex.direction, known.exactTo, t);
        known.exactTo = t;
        const auto exact = Spectrum<N>::map([&](int c) { return std::exp(-known.exact[c]); });
        return passes + (exact - passes) * known.correction;
    }

    void readTooth(std::size_t lane, Spectrum<N> passes) {
        const Vec3d at = positionOf(lane);
        Rgb q;
        for (const EmissionLattice::Source& source : lattice_[lane]->emission())
            q += toRgb(medium::read<3>(*source.field, source.index(at), medium::InFull())) *
                 source.scale;
        Ray& ray = rays_[ray_[lane]];
        if (auto& known = known_[lane])
            passes = passesFromCamera(*known, vertexOf(ray), entry_[lane] + double{t_[lane]});
        const Rgb light = q * toRgb(passes) * (spacing_[lane] * perGlow_[lane]);
        ray.light += light;
        if (const auto& depth = vertexOf(ray).depth; depth && light != Rgb())
            batch_.paths[vertexOf(ray).path].result->stopped->arrivals.push_back(
                {static_cast<float>(depth->at(entry_[lane] + double{t_[lane]})), light, false});
        toTooth_[lane] = spacing_[lane];
        if (--teeth_[lane] == 0) nextRay(lane);
    }

    /// Brings what a ray has gathered to its path.
    void handIn(const Ray& ray) {
        if (ray.light == Rgb()) return;
        const EmissionVertex<N>& vertex = vertexOf(ray);
        PathState<N, false>& p = batch_.paths[vertex.path];
        if (!vertex.scatters) p.result->film.glow = 1;
        bring(batch_, p,
              ray.light * ray.weight * toRgb(vertex.throughput * vertex.correction) *
                  (1 / static_cast<float>(vertex.rays)),
              vertex.kind, scene_.emission[vertex.set].group());
    }

    const LaneScene& scene_;
    Batch<N, false>& batch_;
    const int channels_ = scene_.greyExtinction ? 1 : N;  // of the transmittance
    std::vector<EmissionVertex<N>> vertices_;
    std::vector<Ray> rays_;
    std::size_t nextRay_ = 0;
    std::uint32_t colliding_ = 0, atTooth_ = 0;  // lanes

    // Position: the cell, and voxels within it; the ray, in voxels per world unit; where it enters.
    Ints way_{}, cell_[3]{}, cells_[3]{}, first_[3]{};
    Floats edge_{}, u_[3]{}, firstU_[3]{}, d_[3]{}, inverse_[3]{}, t_{};
    Floats residual_{}, perResidual_{}, glow_{}, perGlow_{}, extinction_[N]{};  // of the cell
    Floats toCollision_{}, toTooth_{}, spacing_{};  // as integrals of `residual_` and `glow_`
    Floats found_{};                                // the integral of `glow_` so far
    Floats depth_[N]{}, passes_[N]{};  // the integral of `extinction_`; what residuals let pass
    Row<std::uint32_t> key_[2]{}, count_{};  // of random numbers
    std::array<const EmissionLattice*, laneCount> lattice_{};
    std::array<const EmissionLattice::Cell*, laneCount> content_{};
    std::array<std::size_t, laneCount> ray_{};
    std::array<int, laneCount> teeth_{};  // that are left
    std::array<double, laneCount> entry_{};
    std::array<std::optional<KnownDepth>, laneCount> known_;  // of cameras' rays
};

}  // namespace woodcock::render::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
