// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "woodcock/error.h"

/// Woodcock as a library: open a scene, change it, render it into memory, write it.
///
///     woodcock::Renderer renderer = woodcock::Renderer::open("smoke.vdb");
///     renderer.set("render.spp", "256");
///     renderer.setResolution(640, 360);
///     const woodcock::RenderedImage image = renderer.render();
///     image.write("smoke.png");
///
/// CMake finds it with find_package(woodcock); link woodcock::woodcock.
///
/// Lengths are world units, angles degrees, colours scene-linear RGB. Whatever goes wrong is thrown
/// as woodcock::Error: Usage for an argument, Input for a file, a scene or values that cannot be
/// used, Failure for the machine (memory, disk). Nothing is printed.
///
/// Threads: render() uses all cores itself. Different objects may be used from different threads
/// at the same time. One object may be used by several threads only through its const functions.

namespace woodcock {

/// Density on a regular lattice of points. Between the points it is interpolated trilinearly, and
/// within one voxel around them it falls to 0.
struct LatticeVolume {
    std::array<int, 3> size{};  ///< points along x, y and z
    std::span<const float>
        density;           ///< size[0] * size[1] * size[2] values, each 0 or more, x
                           ///< fastest: point (i, j, k) is [i + size[0] * (j + size[1] * k)]
    double voxelSize = 1;  ///< between neighbouring points, world units
    std::array<double, 3> origin{};  ///< of point (0, 0, 0), world space
    /// sigma_t = scale * density, per world unit. Absent: chosen, so that a typical ray through the
    /// volume has an optical depth of about 20.
    std::optional<double> scale = {};
    std::array<double, 3> albedo{1, 1, 1};  ///< sigma_s / sigma_t of red, green and blue, 0 to 1
    double g = 0;  ///< mean cosine of the Henyey-Greenstein phase function, between -1 and 1
    /// Another phase function, in place of g: the value of a scene file's key `phase`, such as
    /// R"({ type = "mie", diameter = 20 })". data/scenes/README.md lists them.
    std::string phase = {};
};

/// How far a render has come.
struct RenderState {
    double fraction = 0;                                     ///< of the planned work, 0 to 1
    double seconds = 0;                                      ///< since the render began
    double secondsLeft = 0;                                  ///< estimate
    int samples = 0;                                         ///< per pixel, complete so far
    double noise = std::numeric_limits<double>::infinity();  ///< as RenderedImage::noise()
};

struct RenderCalls {
    /// Called a few times a second, from one thread at a time, not always the same.
    std::function<void(const RenderState&)> progress = {};
    /// Called as often; true stops the render. What is complete by then is kept.
    std::function<bool()> stop = {};
    int threads = 0;  ///< 0: one for each core
};

/// A picture in memory. Copies share their pixels.
class RenderedImage {
public:
    int width() const;
    int height() const;

    /// height * width * 4 floats: rows from the top, pixels from the left, each red, green, blue
    /// and alpha. Colours are scene-linear and multiplied by alpha, and denoised where the scene
    /// says so (render.denoise). Valid as long as this image, or a copy of it, lives.
    std::span<const float> pixels() const;

    int samples() const;    ///< complete per pixel
    bool complete() const;  ///< false where it was stopped, or a limit of time or noise was reached
    double seconds() const;  ///< that the render took
    /// Relative standard error of what the scene shows, as one number; below 0.01 no grain is seen.
    /// Infinite below two samples. Of a denoised picture it is that before.
    double noise() const;
    /// What was chosen for you, and what you should know of the scene; a sentence or more each.
    const std::vector<std::string>& notes() const;

    /// Writes the picture in the format of the file's extension: .exr scene-linear, .png and .jpg
    /// through the display transform of the scene's [output]. The file is written whole or not at
    /// all. Throws Error: Usage on unknown extensions and on folders that are not there, Input on
    /// an OpenColorIO configuration that cannot be used, Failure where writing fails.
    void write(const std::filesystem::path& file) const;

private:
    friend class Renderer;
    struct Impl;
    explicit RenderedImage(std::shared_ptr<const Impl> impl);
    std::shared_ptr<const Impl> impl_;
};

/// A scene, and what you change of it. Nothing that a scene names is opened before render().
class Renderer {
public:
    /// A scene without anything in it, for addVolume().
    Renderer();
    ~Renderer();
    Renderer(Renderer&&) noexcept;
    Renderer& operator=(Renderer&&) noexcept;

    /// A scene file (.toml), or a volume (.vdb, .nvdb) around which a scene is made: its density
    /// grid, its scale, the camera and the lights are chosen. Throws Error{Input}, with file, line
    /// and column, where a scene file cannot be read or is wrong.
    static Renderer open(const std::filesystem::path& file);
    /// The text of a scene file; relative paths in it count from `folder`.
    static Renderer fromText(std::string_view toml, const std::filesystem::path& folder = ".");

    /// Sets one value of the scene file by its name, as `woodcock render --set KEY=VALUE` does:
    /// set("volume[0].scale", "2"), set("render.max_bounces", "8"). data/scenes/README.md lists
    /// the keys. Throws Error where there is no such key or no such value; the scene then stays as
    /// it was.
    void set(std::string_view key, std::string_view value);

    /// In pixels, from 1 to 65536.
    void setResolution(int width, int height);
    void setSamples(int perPixel);  ///< 1 or more
    /// The same scene, seed and number of samples give the same picture, bit for bit, whatever the
    /// number of threads. Below 2^63.
    void setSeed(std::uint64_t seed);
    /// The camera stands at `eye` and looks at `target`, with `up` upwards in the picture; points
    /// and a direction in world space. Replaces a pose that the scene gives in another way.
    void placeCamera(std::array<double, 3> eye, std::array<double, 3> target,
                     std::array<double, 3> up = {0, 1, 0});

    int width() const;
    int height() const;
    int samples() const;
    std::uint64_t seed() const;

    /// Adds a volume from memory; the values are copied. Returns its index: set("volume[1].g",
    /// "0.5") changes a volume of index 1. Throws Error{Usage} where `density` has not as many
    /// values as `size` says, and Error{Input} on negative values, NaN and infinity, and on what a
    /// scene file could not say either (an albedo above 1, say).
    int addVolume(const LatticeVolume& volume);

    /// Loads what the scene names, chooses what it leaves open, and renders it. The scene itself
    /// stays as it is, so that you can render again after a change. Throws Error.
    RenderedImage render(const RenderCalls& calls = {}) const;

    /// Of the library that is linked: "major.minor.patch".
    static std::string libraryVersion();

private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace woodcock
