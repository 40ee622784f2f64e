// SPDX-License-Identifier: Apache-2.0
// Compiled once for each set of instructions: see trace_lanes.cpp.
#if defined(WOODCOCK_LANE_TRACER) == defined(HWY_TARGET_TOGGLE)
#ifdef WOODCOCK_LANE_TRACER
#undef WOODCOCK_LANE_TRACER
#else
#define WOODCOCK_LANE_TRACER
#endif

#include <array>
#include <vector>

#include "woodcock/render/batch.h"
#include "woodcock/render/lanes/lane_emission-inl.h"
#include "woodcock/render/lanes/lane_rows-inl.h"
#include "woodcock/render/lanes/lane_scene.h"
#include "woodcock/render/stages/event_numbers.h"

HWY_BEFORE_NAMESPACE();
namespace woodcock::render::HWY_NAMESPACE {

/// An inverse or a distance that no path has; finite, so that a product with 0 is a number.
inline constexpr float huge = 1e30f;
/// Cells are taken to be at most so wide, in voxels, that a float within one is exact enough.
inline constexpr int widestLog2 = 7;

/// What a lane does.
enum State : std::int32_t {
    Idle,       ///< there are no more paths
    Walking,    ///< from cell to cell
    Colliding,  ///< a tentative collision is to be decided
    Arrived,    ///< it has scattered
    Departing   ///< a turn and a new flight are to be drawn
};

/// The walk of one part's tentative collisions along a flight, while its lane does something else.
/// Positions are within the cell, and directions those of its part's voxels.
struct Process {
    std::array<float, 3> u, d, inverse;
    std::array<std::int32_t, 3> corner;
    float size, mu, perMu, depth, t, lower, upper;
    double entry = 0;    ///< into the part's support, along the ray
    bool waits = false;  ///< at a collision, at `t`
    bool ended = false;
};

/// Traces the paths of a batch, one in each lane; N: tracked channels. Its methods are in files of
/// their own, by what they do:
///
///     lane_paths-inl.h       gives lanes their paths, and ends them
///     lane_camera-inl.h      draws where camera rays scatter, where that needs no walk
///     lane_depths-inl.h      the optical depth along such a ray
///     lane_walk-inl.h        from cell to cell, until a tentative collision
///     lane_collisions-inl.h  decides tentative collisions
///     lane_expected-inl.h    takes off what chance does to the light from far away
///     lane_sun-inl.h         brings sunlight to where paths scatter
///     lane_scattering-inl.h  what else happens there: turns, further flights, splitting, roulette
///     lane_emission-inl.h    brings the light of what glows, by rays of its own
///
/// What all lanes do is done in vectors, and look-ups lane by lane.
template <int N>
class LaneTracer {
public:
    LaneTracer(const LaneScene& scene, Batch<N, false>& batch)
        : scene_(scene),
          traced_(scene.traced),
          batch_(batch),
          emission_(scene, batch),
          several_(scene.partCount > 1),
          samplesLights_(!scene.others.empty() || (scene.sun >= 0 && !scene.delta)) {
        const Vec3d sun = scene.centre.direction;
        for (int i = 0; i < 3; ++i) toSun_[i].set(all(static_cast<float>(sun[i])));
        sunScale_.set(all(1));
    }

    void run() {
        for (std::size_t lane = 0; lane < laneCount; ++lane) nextPath(lane);
        while (true) {
            const Mask walking = whoIs(Walking), arrived = whoIs(Arrived),
                       departing = whoIs(Departing);
            const std::size_t walkers = hn::CountTrue(lanesF, walking);
            const std::size_t colliders = hn::CountTrue(lanesF, whoIs(Colliding));
            const std::size_t waiting = hn::CountTrue(lanesF, hn::Or(arrived, departing));
            if (waiting >= enough || (walkers + colliders == 0 && waiting > 0)) {
                if (const std::uint32_t bits = bitsOf(arrived)) arrive(bits);
                if (const Mask now = whoIs(Departing); !hn::AllFalse(lanesF, now)) depart(now);
            } else if (colliders >= enoughCollide || (walkers == 0 && colliders > 0)) {
                decideCollisions();
            } else if (walkers > 0) {
                step(walking);
            } else {
                break;
            }
        }
        emission_.run();
    }

    const medium::TrackingCounters& counters() const { return counters_; }

private:
    /// So many lanes wait until what happens at a scattering is worth doing. Of 3 to 6 of 8, 4 to 6
    /// measured alike.
    static constexpr std::size_t enough = (laneCount * 5 + 7) / 8;
    /// The same of tentative collisions. Of 1 to 4 of 8, 2 and 3 measured alike, and best.
    static constexpr std::size_t enoughCollide = (laneCount + 3) / 4;

    /// Copies of a path that wait at a scattering until the one before them has ended.
    struct Branch {
        Process vertex;
        light::ScatterPoint from;  ///< PathState::from
        std::uint8_t set;
        std::size_t part, phase;
        std::array<float, 3> direction;
        Spectrum<N> throughput, predicted;
        std::int64_t scatterings;
        int copies;
    };

    /// A point at which a camera ray scatters.
    struct CameraPoint {
        double t;            ///< its distance
        Spectrum<N> passes;  ///< what its depths let pass up to there
        float weight;        ///< one over the density with which points are drawn there
        Spectrum<N> correction{1.0f};
        bool corrected = false;
        /// What each part stops there, before the correction.
        Spectrum<N> stopped[CameraDepths::mostParts]{};
        Rgb light{};  ///< that the path has brought from there
    };

    /// What a lane's path has that is not in vectors.
    struct Lane {
        std::uint32_t path;
        std::uint8_t set = 0;            ///< of media: see PathState::mediumSet
        std::size_t part = 0;            ///< that walks now, of the set
        std::size_t matter = none;       ///< number in LaneScene of the part in the vectors
        std::size_t phase = 0;           ///< and of the one whose phase function turns the path
        std::size_t nearest = none;      ///< the part with the nearest collision so far
        double flightStart = 0;          ///< where distances along the flight count from
        std::vector<Process> processes;  ///< of each part, where there are several
        Vec3d position;                  ///< of the last scattering; there
        std::vector<Branch> branches;    ///< that are still to be followed
        bool first = true;               ///< this branch has quasi-random numbers
        bool quasiRandom = false;        ///< also for the turn and the flight ahead
        std::int64_t scatterings = 0;    ///< of the branches and points before

        // Of a path that scatterCameraRay() has begun:
        bool fromCamera = false;
        Vec3d cameraDirection;
        SampleSequence sequence{0, 0, 0, 0};
        Spectrum<N> passes;  ///< of the camera ray
        Spectrum<N> worth;   ///< what light that stops there is expected to bring
        std::vector<CameraPoint> points;
        std::size_t point = 0;  ///< that it scatters at now
        Rgb radianceBefore;     ///< what it has brought before that one
        std::vector<Rgb> partsBefore;

        // Of several flights from where the path has turned:
        bool extra = false;  ///< this is one of them, and not the path's own
        int flights = 1, extraLeft = 0, ownStratum = 0;
        float ownDepth = 0;
        Process start;
        light::ScatterPoint startFrom;  ///< PathState::from
        std::uint8_t startSet = 0;
        std::size_t startPart = 0;
        std::array<float, 3> direction;
        Spectrum<N> throughput, chance;
        Spectrum<N> gain;  ///< as before the other flights, whose depths depend on its own
    };
    static constexpr std::size_t none = ~std::size_t{0};

    Mask whoIs(State s) const { return hn::RebindMask(lanesF, state_.get() == hn::Set(lanesI, s)); }
    PathState<N, false>& pathOf(std::size_t lane) { return batch_.paths[lanes_[lane].path]; }
    std::size_t numberOf(std::size_t lane, std::size_t part) const {
        return lanes_[lane].set * scene_.partCount + part;
    }
    const LanePart& partOf(std::size_t lane) const {
        return scene_.parts[numberOf(lane, lanes_[lane].part)];
    }
    const LanePart& phaseOf(std::size_t lane) const { return scene_.parts[lanes_[lane].phase]; }
    Vec3d directionOf(std::size_t lane) {
        return {double{v_[0][lane]}, double{v_[1][lane]}, double{v_[2][lane]}};
    }
    Vec3d positionOf(std::size_t lane);
    Spectrum<N> throughputOf(std::size_t lane) { return laneOf(w_, lane); }
    static Spectrum<N> laneOf(Floats* rows, std::size_t lane) {
        Spectrum<N> s;
        for (int c = 0; c < N; ++c) s[c] = rows[c][lane];
        return s;
    }
    static void setLane(Floats* rows, std::size_t lane, const Spectrum<N>& s) {
        for (int c = 0; c < N; ++c) rows[c][lane] = s[c];
    }
    F mostThroughput() const {
        F most = w_[0].get();
        for (int c = 1; c < N; ++c) most = hn::Max(most, w_[c].get());
        return most;
    }
    /// Four random words for each lane where `where` is true.
    void draw(Mask where, U words[4]);

    // ---- lane_paths-inl.h
    void nextPath(std::size_t lane);
    void lookForEmission(std::size_t lane, const LanePart* scatters);
    std::vector<medium::FlightCollision>* collisionsOf(std::size_t lane);
    void leave(std::size_t lane);
    double hitWeight(std::size_t lane, int light);
    void end(std::size_t lane, bool lost);
    void endCameraFlight(std::size_t lane, bool scattered);
    void endBranch(std::size_t lane);
    void bringControls(std::size_t lane);

    // ---- lane_camera-inl.h
    bool scatterCameraRay(std::size_t lane);
    void correctCameraRay(std::size_t lane, float chance);
    bool nextPoint(std::size_t lane);
    bool scatterAt(std::size_t lane, CameraPoint& point);
    void endPoint(std::size_t lane);
    Spectrum<N> worthOf(const PathState<N, false>& p);
    void endCameraPath(std::size_t lane);
    void noteCameraStops(std::size_t lane);

    // ---- lane_walk-inl.h
    bool begin(std::size_t lane, Vec3d origin, float depth);
    void enter(const LanePart& part, Vec3d origin, Vec3d direction, float depth, Process& process);
    void put(std::size_t lane, const Process& process);
    void scatterIn(std::size_t lane);
    void load(std::size_t lane, std::size_t number);
    void loadMatter(std::size_t lane, std::size_t number);
    void take(std::size_t lane, Process& process);
    bool findNearest(std::size_t lane);
    void goOnWithNextPart(std::size_t lane);
    void step(Mask walking);
    void cross(Mask crossing, const Mask along[3]);

    // ---- lane_collisions-inl.h
    void decideCollisions();
    Mask decide(Mask colliding, const F f[N], F random);
    void lookUp(std::uint32_t bits, const U words[4], F f[N]);
    void noteCollision(std::size_t lane, bool ends);

    // ---- lane_expected-inl.h
    void findExpected(std::uint32_t bits);
    F aheadIn(int c) const;
    F expectedWith(int c, F more) const;
    float expectedToScatter(std::size_t lane, int c);
    void noteTurn(std::uint32_t turned, const F before[N]);
    void foresee(Mask flying);
    void noteFlight(Mask colliding);
    void noteLeaving(std::size_t lane);
    F phaseOfNextEvent() const;
    void noteDecision(int c, Mask colliding, Mask scatters, F scattering, F null, F after, F phase);

    // ---- lane_sun-inl.h
    void turnToLamp(std::uint32_t bits);
    struct SunDepths;
    SunDepths readSunDepths(std::uint32_t bits);
    F phaseTowardsSun(F g) const;
    Rgb sampleSun(std::size_t lane);
    F addSunlight(std::uint32_t lit);
    void bringSunlight(std::size_t lane, Rgb light, Spectrum<N> passes, float corrected);
    void predictNextEvent(std::uint32_t lit, const SunDepths& depths);
    F takePrediction(Mask departing);

    // ---- lane_scattering-inl.h
    void arrive(std::uint32_t arrived);
    bool mayGoOn(std::size_t lane);
    void enterMedium(std::size_t lane);
    void addOtherLight(std::size_t lane);
    void findProbabilities(const light::ScatterPoint& from);
    void goOn(std::size_t lane, float growth);
    bool keepWindow(std::size_t lane, float target);
    void depart(Mask departing);
    void turn(Mask departing, std::uint32_t bits, F u0, F u1);
    void play(Mask departing, F random);
    void takeDirection(Mask departing);
    bool takeOff(std::size_t lane, float depth);
    void flySeveralTimes(std::size_t lane, int more, float depth);
    void flyAgain(std::size_t lane);
    void endExtra(std::size_t lane);

    const LaneScene& scene_;
    const TracedScene& traced_;
    Batch<N, false>& batch_;
    EmissionTracer<N> emission_;
    const bool several_;        // parts
    const bool samplesLights_;  // with numbers, from PathState::from
    // Of the last pixel that worthOf() has found:
    struct {
        int x = -1, y = -1;
        Spectrum<N> value;
    } worth_;
    std::vector<float> picks_, probabilities_;
    std::size_t nextPath_ = 0;
    medium::TrackingCounters counters_;
    std::array<Lane, laneCount> lanes_;

    Ints state_{};
    Row<std::uint32_t> key_[2]{}, count_{};  // of random numbers
    // The walk: position and size of the cell, position in it, the ray, and bounds of the field.
    Ints corner_[3]{};
    Floats size_{}, u_[3]{}, d_[3]{}, inverse_[3]{}, lower_{}, upper_{};
    Floats mu_{}, perMu_{};           // rate of tentative collisions, and one over it
    Floats depth_{}, t_{}, limit_{};  // to the next collision; along the flight; its end
    Floats v_[3]{}, density_{};       // the direction in the world; how it was drawn
    Floats w_[N]{};                   // throughput
    // Of the part that walks:
    Ints low_[3]{}, high_[3]{}, latticeCells_[3]{};
    Floats absorption_[N]{}, scattering_[N]{}, channelWeight_[N]{}, extinction_{}, g_{};
    Floats jitterUnit_{}, firstJitter_{}, lattice_[3][4]{}, perspective_[2]{}, beside_{},
        cells_[3][4]{}, sunColour_[N]{}, albedo_[N]{};
    // The direction to the sun, and its irradiance as a multiple of LaneScene::centre's. A lamp's
    // are those where the path has scattered last.
    Floats toSun_[3]{}, sunScale_{};
    // The radiance that a path is expected to bring from far away: going anywhere, how that grows
    // along each axis, and by how much more a path brings that goes along each. And the irradiance
    // of the sun there.
    Floats expected_[N]{}, expectedSlope_[N][3]{}, expectedAhead_[N][3]{}, expectedSun_[N]{};
    // By how much more a path is expected to bring that collides than one that flies on; and the
    // optical depth that was drawn for its flight. See foresee().
    Floats gain_[N]{}, drawn_{};
    // Control variates: what chance has brought too much, as radiance; and what was predicted of
    // the next event, as throughput.
    Floats chance_[N]{}, prediction_[N]{}, predicted_[N]{};
    Floats scattered_{};  // 1 behind the first scattering
    Floats share_{};
    std::array<EventNumbers, laneCount> numbers_{};
    std::array<Rgb, laneCount> sunLight_{};
    std::array<Vec3d, laneCount> sunDirection_{};
};

template <int N>
void LaneTracer<N>::draw(Mask where, U words[4]) {
    const U zero = hn::Zero(lanesU), count = count_.get();
    const U key[4] = {key_[0].get(), key_[1].get(), zero, zero};
    const U counter[4] = {count, zero, zero, zero};
    threefry(key, counter, words);
    count_.set(hn::RebindMask(lanesU, where), count + hn::Set(lanesU, 1));
}

template <int N>
Vec3d LaneTracer<N>::positionOf(std::size_t lane) {
    Vec3d at;
    for (int i = 0; i < 3; ++i) at[i] = double{u_[i][lane]} + corner_[i][lane];
    return partOf(lane).part->description().worldFromIndex.point(at);
}

}  // namespace woodcock::render::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
