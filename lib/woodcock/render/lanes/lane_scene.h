// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <optional>
#include <vector>

#include "woodcock/render/lanes/emission_lattice.h"
#include "woodcock/render/traced_scene.h"

namespace woodcock::render {

/// One part of the medium, as lanes read it.
struct LanePart {
    const medium::MediumPart* part;
    float indexFromWorld[3][3];      ///< of vectors; by rows
    Vec3i low, high;                 ///< voxels of the support, both ends included
    bool henyeyGreenstein;           ///< else its phase function is sampled path by path
    float g;                         ///< of Henyey-Greenstein
    float latticeFromIndex[3][4]{};  ///< from voxels, of which `low` is the first, to those of
                                     ///< LaneScene::sunDepths; by rows
    float cellsFromIndex[3][4]{};    ///< the same to the cells of LaneScene::radiance
    Rgb albedo;                      ///< sigma_s / sigma_t
    float windowScale;               ///< see LaneTracer::keepWindow()

    explicit LanePart(const medium::MediumPart& part);
    /// Fills one of these maps.
    void setLattice(float (&map)[3][4], const Affine3d& latticeFromWorld) const;
};

/// A scene whose paths are traced in the lanes of vectors: see trace_lanes.h. It refers to the
/// TracedScene, which must outlive it.
struct LaneScene {
    const TracedScene& traced;
    /// Of the scene's own medium, and then as many of the one that similarity uses in its place.
    std::vector<LanePart> parts;
    std::size_t partCount = 0;  ///< of one medium
    /// The grids, of each medium, of the optical depth to the sun, which every scattering samples;
    /// null: there is none. The sun is a light of type sun, one of an environment's image, or a
    /// lamp outside of the medium.
    std::array<const medium::DepthGrid*, 2> sunDepths{};
    int sun = -1;
    bool lamp = false;          ///< its direction and irradiance differ from place to place
    bool delta = false;         ///< it has no disc
    light::LightSample centre;  ///< its direction and irradiance; a lamp's in the medium's middle

    light::LightSample sunAt(Vec3d world) const { return lamp ? sunlight(sun, world) : centre; }
    /// Other lights that are sampled, one for each scattering: not the environments that are so
    /// even that paths find their light well enough where they leave.
    std::vector<int> others;
    /// Mean radiance from all around, of environments that are not among these, and the first of
    /// them; -1: there is none.
    Rgb environment{};
    int environmentLight = -1;
    bool greyExtinction = true;
    std::vector<EmissionLattice> emission;  ///< of each set of media; empty: nothing glows
    /// Paths are long: it pays to split and to end them by where they are.
    bool thick = false;
    /// What paths are expected to bring of the light from far away; null: it is not known.
    const RadianceLattice* radiance = nullptr;
    /// Decisions on camera rays are controlled as well: where rays see the environments, and carry
    /// more or less of their light by what is decided.
    bool controlsCameraFlights = false;
    /// Flights are controlled as well, by how much light comes along them. That pays where a flight
    /// is about as long as a cell of `radiance`, and costs where it is much longer.
    bool controlsFlights = false;
    /// Radiance of which LaneTracer::chance_ has multiples: without a lattice, the environment's.
    /// And the light that its control variate counts to; -1: there is none.
    Rgb chanceUnit{};
    int chanceLight = -1;
    Rgb sunPerUnit{};  ///< the irradiance of `centre`, in chanceUnit; 0 if another light counts
    /// Depths along camera rays; null: they are walked.
    const CameraDepths* cameraDepths = nullptr;
    Rgb cameraAlbedo;  ///< of all parts: sigma_s / sigma_t
    int points = 1;    ///< of a camera ray that has such depths, at which its path scatters

    /// Nothing where the scene needs more than lanes can do; its paths are then traced one by one.
    static std::optional<LaneScene> make(const TracedScene& traced);

private:
    explicit LaneScene(const TracedScene& t) : traced(t) {}
    void addLights();
    void findSun();
    bool hasDepths(int light) const;  ///< of all media
    /// The irradiance of a sun or lamp at a place, by one sample, and its direction there.
    light::LightSample sunlight(int light, Vec3d world) const;
    void addRadiance();
    void addCameraDepths();
};

}  // namespace woodcock::render
