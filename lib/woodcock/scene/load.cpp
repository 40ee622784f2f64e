// SPDX-License-Identifier: Apache-2.0
#include "woodcock/scene/load.h"
#include "woodcock/scene/next_frame.h"

#include <algorithm>
#include <atomic>
#include <string>

#include "woodcock/base/error.h"
#include "woodcock/base/regular_file.h"
#include "woodcock/grid/grid_roles.h"
#include "woodcock/grid/vdb/load_field.h"
#include "woodcock/grid/velocity.h"
#include "woodcock/image/read_image.h"
#include "woodcock/medium/blackbody.h"
#include "woodcock/scene/keys/sections.h"
#include "woodcock/scene/load_surfaces.h"

namespace woodcock::scene {
namespace {

/// Sets values above 1 to 1; returns how many voxels (of `channels` values) had one.
std::uint64_t limit(std::span<float> values, int channels) {
    std::uint64_t count = 0;
    const auto step = static_cast<size_t>(channels);
    for (size_t i = 0; i + step <= values.size(); i += step) {
        const auto voxel = values.subspan(i, step);
        count += std::any_of(voxel.begin(), voxel.end(), [](float v) { return v > 1; });
        for (float& v : voxel) v = std::min(v, 1.0f);
    }
    return count;
}

std::string limitAlbedo(const grid::VdbFile& file, const grid::GridListing& grid,
                        const grid::LoadOptions& options, grid::Field& field) {
    const float largest = field.range().max;
    if (!(largest > 1)) return {};

    // Rare enough to read the voxels once more.
    grid::FieldSource source =
        grid::readGridSource(file, grid, {options.repair, options.repair}).field;
    std::atomic<std::uint64_t> count = 0;
    const auto channels = static_cast<size_t>(source.channels);
    for (grid::FieldTile& tile : source.tiles)
        if (limit(std::span(tile.value).first(channels), source.channels) > 0)
            count += static_cast<std::uint64_t>(tile.size) * static_cast<std::uint64_t>(tile.size) *
                     static_cast<std::uint64_t>(tile.size);
    limit(std::span(source.background).first(channels), source.channels);
    source.copyLeaf = [&, copy = source.copyLeaf](size_t i, std::span<float> values) {
        copy(i, values);
        count += limit(values, source.channels);
    };
    grid::Field limited = grid::buildField(source, field.storage());

    const std::string found =
        fmt::format("albedo grid '{}' in {} holds {} voxel{} above 1 (up to {})", grid.uniqueName,
                    file.path.string(), count.load(), count == 1 ? "" : "s", largest);
    if (!options.repair)
        throw inputError(
            "{}; an albedo lies between 0 and 1: --repair (in a scene file: repair = "
            "true) sets them to 1",
            found);
    field = std::move(limited);
    return found + ": set to 1";
}

/// What a grid is read for.
enum class Purpose { Density, Coefficient, Albedo };

/// Of the volume's media: an albedo is no medium, and reaches everywhere.
grid::GridReach reachOf(const VolumeDescription& volume) {
    const Background usual = volume.inside.empty() ? Background::Clip : Background::Endless;
    return volume.background.value_or(usual) == Background::Clip ? grid::GridReach::ActiveVoxels
                                                                 : grid::GridReach::Everywhere;
}

/// What glows of a temperature grid.
struct LoadedGlow {
    LoadedField field;
    float ambient = 0, hottest = 0;  ///< values of the grid: its background, its largest
};

/// Reads files and grids, each once.
class Loader {
public:
    Loader(const RenderDescription& render, LoadCache& cache)
        : usual_(render.storage), lookup_(render.lookup), cache_(cache) {}

    const grid::VdbFile& file(const VolumeDescription& volume) {
        static const grid::VdbFile nothing;
        if (volume.black) return nothing;
        return cache_.get<grid::VdbFile>(cacheName("file", volume.file.string()), [&] {
            grid::VdbFile listed = grid::listGrids(volume.file);
            note(listed.warning);
            return listed;
        });
    }

    LoadedField field(const VolumeDescription& volume, const std::string& name, Purpose purpose,
                      grid::GridReach reach) {
        const grid::VdbFile& vdb = file(volume);
        if (vdb.grids.empty()) return nothingOf(vdb, name);
        grid::FoundGrid found =
            name.empty() ? grid::findGrid(vdb, grid::GridRole::Density) : grid::findGrid(vdb, name);
        const bool albedo = purpose == Purpose::Albedo;
        if (albedo) reach = grid::GridReach::Everywhere;
        return cache_.get<LoadedField>(
            cacheName("field", volume.file.string(), found.grid.uniqueName, storageOf(volume),
                      lookup_, volume.repair, purpose, reach),
            [&] { return readField(volume, vdb, std::move(found), purpose, reach); });
    }

    /// What glows of a temperature grid, for volumes of one scale and offset.
    LoadedField blackbody(const VolumeDescription& volume, float& ambient) {
        const BlackbodyDescription& b = *volume.blackbody;
        const grid::VdbFile& vdb = file(volume);
        if (vdb.grids.empty()) return nothingOf(vdb, b.temperature);
        grid::FoundGrid found = b.temperature.empty()
                                    ? grid::findGrid(vdb, grid::GridRole::Temperature)
                                    : grid::findGrid(vdb, b.temperature);
        const std::string name = found.grid.uniqueName;
        const LoadedGlow& glow =
            cache_.get<LoadedGlow>(cacheName("glow", volume.file.string(), name, storageOf(volume),
                                             lookup_, volume.repair, b.scale, b.offset),
                                   [&] { return readGlow(volume, vdb, std::move(found)); });
        const double brightest =
            double{glow.field.field->range().max} * b.intensity * b.colour.maximum();
        if (!(brightest < std::numeric_limits<float>::max()))
            throw inputError(
                "grid '{}' in {} is too hot: up to {:.6g} kelvins, whose light no "
                "float holds; scale and offset turn its values into kelvins",
                name, vdb.path.string(), b.scale * double{glow.hottest} + b.offset);
        ambient = glow.ambient;
        return glow.field;
    }

    /// The grids of a volume's velocities; none where it names none and has none.
    grid::VelocityGrids velocityGrids(const VolumeDescription& volume) {
        const grid::VdbFile& vdb = file(volume);
        if (vdb.grids.empty()) return {};
        const std::string& name = volume.velocity.grid;
        return name.empty() ? grid::findVelocities(vdb) : grid::findVelocities(vdb, name);
    }

    /// Null where they are 0 everywhere.
    std::shared_ptr<const grid::Velocity> velocity(const VolumeDescription& volume,
                                                   const grid::VelocityGrids& grids) {
        const bool asStored = volume.velocity.sampling == VelocityDescription::Sampling::AsStored;
        const auto name = cacheName("velocity", volume.file.string(), grids.front().uniqueName,
                                    asStored, volume.repair);
        using Read = std::shared_ptr<const grid::Velocity>;
        return cache_.get<Read>(name, [&] { return readVelocity(volume, grids, asStored); });
    }

    /// The values of a grid that is only spoken of; nothing where there are none, they are not
    /// known, or would take long.
    std::optional<grid::VoxelScan> look(const VolumeDescription& volume, const std::string& name,
                                        grid::GridUse use) {
        constexpr std::uint64_t long_ = std::uint64_t{64} << 20;
        if (name.empty()) return std::nullopt;
        const grid::VdbFile& vdb = file(volume);
        const grid::FoundGrid found = grid::findGrid(vdb, name);
        if (found.grid.fileBytes > long_) return std::nullopt;
        try {
            const grid::LoadOptions options{.use = use, .nonNegative = false, .repair = true};
            const grid::VoxelScan scan = grid::loadGrid(vdb, found.grid, options).statistics.voxels;
            return scan.finite > 0 ? std::optional(scan) : std::nullopt;
        } catch (const Error&) {
            return std::nullopt;  // what is wrong with it is told where it is used
        }
    }

    std::vector<std::string> takeNotes() { return std::move(notes_); }

private:
    LoadedField readField(const VolumeDescription& volume, const grid::VdbFile& vdb,
                          grid::FoundGrid found, Purpose purpose, grid::GridReach reach) {
        note(std::move(found.note));
        const bool albedo = purpose == Purpose::Albedo;
        // A velocity that happens to be nowhere negative is no density.
        const bool velocity =
            purpose == Purpose::Density && grid::isNamedFor(found.grid, grid::GridRole::Velocity);
        const grid::LoadOptions options{
            .use = velocity ? grid::GridUse::Scalar : grid::GridUse::Colour,
            .reach = reach,
            .storage = storageOf(volume),
            .repair = volume.repair};
        grid::LoadedGrid grid = grid::loadGrid(vdb, found.grid, options);
        for (std::string& text : grid.notes) note(std::move(text));
        if (purpose == Purpose::Density && found.grid.channels == 3)
            note(
                fmt::format("grid '{}' in {} is a vector grid ({}): its three numbers are the "
                            "densities of red, green and blue",
                            found.grid.uniqueName, vdb.path.string(), found.grid.valueType));
        if (!albedo && volume.inside.empty()) noteBackground(vdb, found.grid, grid.field);
        if (albedo) note(limitAlbedo(vdb, found.grid, options, grid.field));
        grid.field.setLookup(lookup_);
        return {std::make_shared<grid::Field>(std::move(grid.field)), grid.worldFromIndex,
                found.grid.uniqueName};
    }
    LoadedGlow readGlow(const VolumeDescription& volume, const grid::VdbFile& vdb,
                        grid::FoundGrid found) {
        const BlackbodyDescription& b = *volume.blackbody;
        note(std::move(found.note));
        LoadedGlow glow;
        grid::LoadOptions options{.reach = grid::GridReach::ActiveVoxels,
                                  .storage = storageOf(volume),
                                  .nonNegative = false,
                                  .repair = volume.repair};
        options.convert = [&](grid::FieldSource source) {
            glow.ambient = source.background[0];
            return medium::blackbodySource(std::move(source), b.scale, b.offset);
        };
        grid::LoadedGrid grid = grid::loadGrid(vdb, found.grid, options);
        for (std::string& text : grid.notes) note(std::move(text));
        glow.hottest = grid.statistics.voxels.max[0];
        grid.field.setLookup(lookup_);
        glow.field = {std::make_shared<grid::Field>(std::move(grid.field)), grid.worldFromIndex,
                      found.grid.uniqueName};
        return glow;
    }
    std::shared_ptr<const grid::Velocity> readVelocity(const VolumeDescription& volume,
                                                       const grid::VelocityGrids& grids,
                                                       bool asStored) {
        std::array<grid::Velocity::Source, 3> sources;
        for (std::size_t i = 0; i < grids.size(); ++i) {
            const grid::LoadOptions options{.use = grid::GridUse::Colour,
                                            .nonNegative = false,
                                            .repair = volume.repair,
                                            .onFaces = true};
            grid::LoadedGrid loaded = grid::loadGrid(file(volume), grids[i], options);
            for (std::string& text : loaded.notes) note(std::move(text));
            sources[i].field = std::make_shared<grid::Field>(std::move(loaded.field));
            sources[i].objectFromIndex = loaded.worldFromIndex;
        }
        for (std::size_t i = 0; i < 3; ++i) {
            const bool vectors = grids.size() == 1;
            if (vectors)
                sources[i] = {sources[0].field, static_cast<int>(i), sources[0].objectFromIndex};
            if (asStored && grids[vectors ? 0 : i].gridClass == grid::GridClass::Staggered)
                sources[i].offset[static_cast<int>(i)] = -0.5;
        }
        auto velocity = std::make_shared<const grid::Velocity>(std::move(sources));
        return velocity->still() ? nullptr : velocity;
    }
    grid::Storage storageOf(const VolumeDescription& volume) const {
        return volume.storage == grid::Storage::Auto ? usual_ : volume.storage;
    }
    /// Of a file without grids, as some programs write frames that hold nothing.
    LoadedField nothingOf(const grid::VdbFile& vdb, const std::string& name) {
        if (!vdb.path.empty())
            note(fmt::format("{} holds no grids: there is nothing in it to be drawn",
                             vdb.path.string()));
        return {std::make_shared<grid::Field>(grid::buildField({}, grid::Storage::Float)),
                {},
                name.empty() ? "density" : name};
    }
    void noteBackground(const grid::VdbFile& vdb, const grid::GridListing& grid,
                        const grid::Field& field) {
        if (field.limits())
            note(
                "background = \"endless\" in a scene's [[volume]] fills all of space with what a "
                "grid has around its active voxels");
        else if (field.storedRange(field.blocks().outside()).max > 0)
            note(
                fmt::format("grid '{}' in {} fills all of space with its background, as the scene "
                            "asks: no light of a sky or a sun comes through it",
                            grid.uniqueName, vdb.path.string()));
    }
    void note(std::string text) {
        const bool known = std::find(notes_.begin(), notes_.end(), text) != notes_.end();
        if (!text.empty() && !known) notes_.push_back(std::move(text));
    }

    grid::Storage usual_;
    grid::Lookup lookup_;
    LoadCache& cache_;
    std::vector<std::string> notes_;
};

/// Blender is the one writer of VDB whose up axis is z; its gas simulations give themselves away by
/// this key, everything else by its name.
bool writtenByBlender(const grid::VdbFile& file) {
    for (const grid::GridListing& grid : file.grids)
        for (const auto& [key, value] : grid.metadata)
            if (key == "file_base_resolution" || value.find("Blender") != std::string::npos)
                return true;
    return false;
}

/// The first grid of velocities, unless it is one of those that are used.
std::string unusedVelocities(const grid::VdbFile& file, const LoadedVolume& loaded) {
    const auto isUsed = [&](const std::string& name) {
        for (const LoadedField* field : {&loaded.density, &loaded.albedo, &loaded.emission,
                                         &loaded.blackbody, &loaded.sigmaA, &loaded.sigmaS})
            if (field->grid == name) return true;
        return false;
    };
    for (const grid::GridListing& grid : file.grids)
        if (grid::meansVelocity(grid) && !isUsed(grid.uniqueName)) return grid.uniqueName;
    return {};
}

/// What glows everywhere is infinitely bright.
void requireDarkBackground(const grid::VdbFile& file, const LoadedField& emission) {
    if (emission.field->limits()) return;
    for (int c = 0; c < emission.field->channels(); ++c)
        if (emission.field->background(c) != 0)
            throw inputError(
                "grid '{}' in {} has a background of {}; one that emits needs 0 where background = "
                "\"endless\" is asked for, or all of space would glow",
                emission.grid, file.path.string(), emission.field->background(c));
}

/// The table that the phase function of `d` names; `path` is that of d's keys.
template <class D>
std::optional<medium::PhaseTable> loadPhase(const SceneDescription& scene, const D& d,
                                            const std::string& path, LoadCache& cache) {
    const auto* table = d.phase ? std::get_if<TablePhase>(&*d.phase) : nullptr;
    if (!table) return std::nullopt;
    const std::string place =
        findPlace(scene.places,
                  fmt::format("{}.{}.{}", path, keyName(d, d.phase), keyName(*table, table->file)));
    return inPlace(place, [&] {
        return cache.get<medium::PhaseTable>(
            cacheName("phase", table->file.string(), table->normalise),
            [&] { return medium::readPhaseTable(table->file, table->normalise); });
    });
}

std::string text(Vec3d p) { return fmt::format("[{:.4g}, {:.4g}, {:.4g}]", p.x, p.y, p.z); }

/// Velocities that lie beside all that they should move are those of something else, or have a
/// wrong transform. The picture would not show it.
void requireOverlap(const grid::VdbFile& file, const grid::VelocityGrids& grids,
                    const LoadedVolume& loaded) {
    const Box3d theirs = loaded.velocity->support();
    if (theirs.empty() || loaded.velocity->background() != Vec3d{}) return;
    Box3d moved;
    for (const LoadedField* field :
         {&loaded.density, &loaded.emission, &loaded.blackbody, &loaded.sigmaA, &loaded.sigmaS})
        if (*field && !field->field->extent().empty())
            moved.add(field->objectFromIndex.box(field->field->extent()));
    if (moved.empty()) return;
    const Box3d common{max(theirs.lower, moved.lower), min(theirs.upper, moved.upper)};
    if (!common.empty()) return;
    throw inputError(
        "the velocities of grid '{}' in {} lie beside what they should move: from {} to {}, and "
        "that is from {} to {}; check the transforms of the grids",
        grids.front().uniqueName, file.path.string(), text(theirs.lower), text(theirs.upper),
        text(moved.lower), text(moved.upper));
}

/// "vel", or "vel.x, vel.y, vel.z".
std::string namesOf(const grid::VelocityGrids& grids) {
    std::vector<std::string> names;
    for (const grid::GridListing& grid : grids) names.push_back(grid.uniqueName);
    return fmt::format("{}", fmt::join(names, ", "));
}

/// What has to be known of grids that a scene does not ask for, to choose what becomes of them.
void lookThrough(const VolumeDescription& volume, Loader& loader, LoadedVolume& loaded) {
    if (!volume.blackbody && !volume.emission) {
        const auto largest = [&](const std::string& grid) {
            const auto scan = loader.look(volume, grid, grid::GridUse::Scalar);
            return scan ? scan->max[0] : 0;
        };
        loaded.hottest = largest(loaded.temperatures);
        loaded.brightest = largest(loaded.flames);
    }
    const auto* c = std::get_if<DensityCoefficients>(&volume.coefficients);
    if (!c || !c->albedoGrid.empty()) return;
    if (const auto scan = loader.look(volume, loaded.colours, grid::GridUse::Colour))
        if (scan->nan.count + scan->infinite.count + scan->negative.count == 0)
            loaded.palest = std::max({scan->max[0], scan->max[1], scan->max[2]});
}

LoadedVolume loadVolume(const SceneDescription& scene, size_t index, Loader& loader,
                        LoadCache& cache) {
    const VolumeDescription& volume = scene.volumes[index];
    LoadedVolume loaded;
    loaded.phase = loadPhase(scene, volume, fmt::format("volume[{}]", index), cache);
    if (std::holds_alternative<HomogeneousBox>(volume.coefficients)) return loaded;
    const auto placeOf = [&](const auto& member) {
        return findPlace(scene.places,
                         fmt::format("volume[{}].{}", index, keyName(volume, member)));
    };
    const auto placeOfGrid = [&](const std::optional<GridCoefficient>& c) {
        return findPlace(scene.places, fmt::format("volume[{}].{}.{}", index, keyName(volume, c),
                                                   keyName(*c, c->grid)));
    };
    const grid::VdbFile& file = inPlace(
        placeOf(volume.file), [&]() -> const grid::VdbFile& { return loader.file(volume); });
    // The first of these that was written is to blame.
    const auto load = [&](const std::string& grid, Purpose purpose,
                          const std::vector<std::string>& places, grid::GridReach reach) {
        const auto written = std::find_if(places.begin(), places.end(),
                                          [](const std::string& place) { return !place.empty(); });
        return inPlace(written == places.end() ? "" : *written,
                       [&] { return loader.field(volume, grid, purpose, reach); });
    };
    const grid::GridReach reach = reachOf(volume);
    if (const auto* c = std::get_if<DensityCoefficients>(&volume.coefficients)) {
        loaded.density =
            load(c->density, Purpose::Density, {placeOf(c->density), placeOf(volume.file)}, reach);
        if (!c->albedoGrid.empty())
            loaded.albedo = load(c->albedoGrid, Purpose::Albedo, {placeOf(c->albedoGrid)}, reach);
    } else {
        const auto& separate = std::get<SeparateCoefficients>(volume.coefficients);
        const std::string density =
            findPlace(scene.places, fmt::format("volume[{}].density", index));
        if (const auto& sigma = separate.sigmaA)
            loaded.sigmaA = load(sigma->grid, Purpose::Coefficient,
                                 {placeOfGrid(sigma), density, placeOf(volume.file)}, reach);
        if (const auto& sigma = separate.sigmaS)
            loaded.sigmaS = load(sigma->grid, Purpose::Coefficient,
                                 {placeOfGrid(sigma), density, placeOf(volume.file)}, reach);
    }
    if (const auto& emission = volume.emission) {
        const auto* c = std::get_if<DensityCoefficients>(&volume.coefficients);
        const bool density = c && c->density == emission->grid;
        const std::vector<std::string> places{placeOfGrid(emission), placeOf(emission)};
        // No surface ends what emits: without being asked, it ends with its active voxels.
        loaded.emission =
            load(emission->grid, density ? Purpose::Density : Purpose::Coefficient, places,
                 volume.background == Background::Endless ? reach : grid::GridReach::ActiveVoxels);
        inPlace(placeOf(emission), [&] { requireDarkBackground(file, loaded.emission); });
    }
    if (volume.blackbody)
        loaded.blackbody = inPlace(placeOf(volume.blackbody),
                                   [&] { return loader.blackbody(volume, loaded.ambient); });
    const auto nameOf = [&](grid::GridRole role) {
        return grid::hasRole(file, role) ? grid::findGrid(file, role).grid.uniqueName
                                         : std::string();
    };
    loaded.temperatures = nameOf(grid::GridRole::Temperature);
    loaded.flames = nameOf(grid::GridRole::Emission);
    for (const grid::GridListing& grid : file.grids)
        if (loaded.colours.empty() && grid.channels == 3 && grid.usable() &&
            grid::isNamedFor(grid, grid::GridRole::Colour))
            loaded.colours = grid.uniqueName;
    if (placeOf(volume.file).empty()) lookThrough(volume, loader, loaded);
    inPlace(placeOf(volume.velocity.grid), [&] {
        const grid::VelocityGrids grids = loader.velocityGrids(volume);
        const bool followed = volume.velocity.scale != 0 && asksForMotion(scene);
        if (grids.empty() || !(scene.needsVelocities(volume) || followed)) return;
        loaded.velocity = loader.velocity(volume, grids);
        loaded.velocities = namesOf(grids);
        if (loaded.velocity) requireOverlap(file, grids, loaded);
    });
    if (loaded.velocities.empty()) loaded.velocities = unusedVelocities(file, loaded);
    if (writtenByBlender(file)) loaded.up = UpAxis::Z;
    return loaded;
}

template <class L>
LoadedLight readLight(const L&) {
    return {};
}
LoadedLight readLight(const EnvironmentDescription& environment) {
    image::Image image = image::readImage(environment.image);
    return {.map = {image.width, image.height, std::move(image.rgb)}};
}
LoadedLight readLight(const PointDescription& point) {
    constexpr std::uint64_t mostBytes = 1 << 24;  // 500 times as much as the largest files have
    const std::string text = readRegularFile(point.ies, "photometric file", mostBytes);
    return {.profile = std::make_shared<const light::IesProfile>(
                light::IesProfile::read(text, point.ies.string()))};
}

template <class L>
std::filesystem::path fileOfLight(const L&) {
    return {};
}
std::filesystem::path fileOfLight(const EnvironmentDescription& light) { return light.image; }
std::filesystem::path fileOfLight(const PointDescription& light) { return light.ies; }

/// Without a cache, nothing is held twice: images of skies may be large.
template <class L>
LoadedLight loadLight(const L& light, LoadCache* cache) {
    const std::filesystem::path file = fileOfLight(light);
    if (file.empty()) return {};
    if (!cache) return readLight(light);
    return cache->get<LoadedLight>(cacheName("light", file.string()),
                                   [&] { return readLight(light); });
}

void loadLights(const SceneDescription& scene, LoadedScene& loaded, LoadCache* cache) {
    loaded.lights.clear();
    for (size_t i = 0; i < scene.lights.size(); ++i)
        std::visit(
            [&]<class L>(const L& light) {
                // The light's file is to blame, of which each type has one at most.
                std::string place;
                for (const Key<L>& key : keysOf<L>().keys)
                    if (key.files && place.empty())
                        place =
                            findPlace(scene.places, fmt::format("light[{}].{}", i, key.info.name));
                loaded.lights.push_back(inPlace(place, [&] { return loadLight(light, cache); }));
            },
            scene.lights[i].light);
}

}  // namespace

LoadedScene loadScene(const SceneDescription& scene, LoadCache* kept) {
    LoadCache own;
    LoadCache& cache = kept ? *kept : own;
    LoadedScene loaded;
    Loader loader(scene.render, cache);
    for (size_t i = 0; i < scene.volumes.size(); ++i)
        loaded.volumes.push_back(loadVolume(scene, i, loader, cache));
    loadLights(scene, loaded, kept);
    loaded.notes = loader.takeNotes();
    loaded.surfaces = loadSurfaces(scene, loaded.notes, cache);
    loaded.textures = loadTextures(scene, cache);
    for (size_t i = 0; i < scene.surfaces.size(); ++i) {
        loaded.interiorPhases.emplace_back();
        const SurfaceDescription& surface = scene.surfaces[i];
        if (surface.interior)
            loaded.interiorPhases.back() = loadPhase(
                scene, *surface.interior,
                fmt::format("surface[{}].{}", i, keyName(surface, surface.interior)), cache);
    }
    cache.forgetUnused();
    return loaded;
}

void loadChosen(const SceneDescription& scene, LoadedScene& loaded, LoadCache* kept) {
    LoadCache own;
    if (loaded.lights.size() != scene.lights.size()) loadLights(scene, loaded, kept);
    Loader loader(scene.render, kept ? *kept : own);
    for (size_t i = 0; i < scene.volumes.size(); ++i) {
        LoadedVolume& volume = loaded.volumes[i];
        const VolumeDescription& chosen = scene.volumes[i];
        if (chosen.blackbody && !volume.blackbody)
            volume.blackbody = loader.blackbody(chosen, volume.ambient);
        const auto* c = std::get_if<DensityCoefficients>(&chosen.coefficients);
        if (c && !c->albedoGrid.empty() && !volume.albedo)
            volume.albedo = loader.field(chosen, c->albedoGrid, Purpose::Albedo, reachOf(chosen));
    }
}

}  // namespace woodcock::scene
