// SPDX-License-Identifier: Apache-2.0
#include "woodcock/scene/choose_camera.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include "woodcock/grid/block_ranges.h"
#include "woodcock/mesh/surface_mesh.h"
#include "woodcock/scene/build.h"

namespace woodcock::scene {
namespace {

constexpr float wisp = 0.01f;
constexpr std::size_t mostPoints = 1 << 20;  // of a surface of which each point is looked at
constexpr double mostBlocks = 1 << 24;       // in a field whose blocks are looked at one by one

void addCorners(const Box3d& box, const Affine3d& toWorld, std::vector<Vec3d>& points) {
    for (int i = 0; i < 8; ++i) points.push_back(toWorld.point(box.corner(i)));
}

Vec3i blockOf(Vec3d p) {
    return Vec3d{std::floor(p.x / 8), std::floor(p.y / 8), std::floor(p.z / 8)}.as<int>();
}

/// The part of the box that lies in the row of blocks along x through (y, z), if any of it is more
/// than a wisp.
Box3d occupiedPart(const grid::Field& field, Vec3i first, Vec3i last) {
    const float least = wisp * field.range().max;
    Box3d part;
    for (Vec3i b = first; b.x <= last.x; ++b.x)
        if (grid::blockRange(field, b).max > least) {
            const Vec3d corner = b.as<double>() * 8;
            part.add(Box3d{corner, corner + Vec3d{8, 8, 8}});
        }
    return part;
}

void addField(const grid::Field& field, const Affine3d& worldFromIndex,
              std::vector<Vec3d>& points) {
    const Box3d extent = field.extent();
    if (extent.empty()) return;
    const Vec3d size = extent.size() / 8 + Vec3d{1, 1, 1};
    if (size.x * size.y * size.z > mostBlocks) return addCorners(extent, worldFromIndex, points);
    const Vec3i first = blockOf(extent.lower), last = blockOf(extent.upper);
    // A row of blocks is as convex as its two ends.
    for (int z = first.z; z <= last.z; ++z)
        for (int y = first.y; y <= last.y; ++y) {
            Box3d part = occupiedPart(field, {first.x, y, z}, {last.x, y, z});
            part.lower = max(part.lower, extent.lower);
            part.upper = min(part.upper, extent.upper);
            if (!part.empty()) addCorners(part, worldFromIndex, points);
        }
}

/// What a block adds to the optical depth of rays that go straight through it.
struct SeenBlock {
    Box3d box;  ///< index space
    double depth;
};

std::vector<SeenBlock> blocksOf(const grid::Field& field, double depthOfVoxel) {
    const Box3d extent = field.extent();
    const Vec3i first = blockOf(extent.lower), last = blockOf(extent.upper);
    std::vector<SeenBlock> blocks;
    for (int z = first.z; z <= last.z; ++z)
        for (int y = first.y; y <= last.y; ++y)
            for (int x = first.x; x <= last.x; ++x) {
                if (!(grid::blockRange(field, {x, y, z}).max > 0)) continue;
                const Vec3d corner = Vec3d{double(x), double(y), double(z)} * 8;
                const Box3d box{max(corner, extent.lower),
                                min(corner + Vec3d{8, 8, 8}, extent.upper)};
                if (box.empty()) continue;
                double sum = 0;
                for (int i = 0; i < 8; ++i) {
                    const Vec3d p{i & 1 ? 6.0 : 2.0, i & 2 ? 6.0 : 2.0, i & 4 ? 6.0 : 2.0};
                    for (int c = 0; c < field.channels(); ++c)
                        sum += field.trilinear(corner + p, c);
                }
                blocks.push_back({box, sum / 8 / field.channels() * 8 * depthOfVoxel});
            }
    return blocks;
}

/// The blocks that a ray along `towards` meets with more than a wisp before, in and behind them.
void addSeen(const grid::Field& field, const Affine3d& worldFromIndex, double scale, Vec3d towards,
             std::vector<Vec3d>& points) {
    constexpr double leastDepth = 0.1;
    const Box3d extent = field.extent();
    if (extent.empty()) return;
    const Vec3d size = extent.size() / 8 + Vec3d{1, 1, 1};
    if (size.x * size.y * size.z > mostBlocks) return addCorners(extent, worldFromIndex, points);
    const double voxel = std::cbrt(std::abs(worldFromIndex.determinant()));
    const std::vector<SeenBlock> blocks = blocksOf(field, scale * voxel);
    // Sums over columns as wide as a block, seen along the view.
    const Vec3d back = normalize(towards);
    const Vec3d side =
        normalize(cross(std::abs(back.y) < 0.9 ? Vec3d{0, 1, 0} : Vec3d{1, 0, 0}, back));
    const Vec3d above = cross(back, side);
    const auto column = [&](const SeenBlock& block) {
        const Vec3d p = worldFromIndex.point(block.box.centre()) / (8 * voxel);
        return std::pair(std::floor(dot(p, side)), std::floor(dot(p, above)));
    };
    std::map<std::pair<double, double>, double> depths;
    for (const SeenBlock& block : blocks) depths[column(block)] += block.depth;
    for (const SeenBlock& block : blocks)
        if (depths[column(block)] > leastDepth) addCorners(block.box, worldFromIndex, points);
}

/// In the space of its mesh; none for an infinite plane.
std::vector<Vec3d> pointsOf(const SurfaceDescription& surface, const LoadedSurface& loaded) {
    std::vector<Vec3d> points;
    const auto add = [&](const mesh::SurfaceMesh& mesh) {
        for (const Vec3f& p : mesh.mesh.points) points.push_back(p.as<double>());
    };
    if (loaded.mesh)
        add(*loaded.mesh);
    else if (std::holds_alternative<SphereShape>(surface.shape))
        add(mesh::sphereMesh(12));
    else if (std::holds_alternative<DiskShape>(surface.shape))
        add(mesh::diskMesh(24));
    return points;
}

void addSurface(const SurfaceDescription& surface, const LoadedSurface& loaded,
                std::vector<Vec3d>& outline) {
    std::vector<Vec3d> points = pointsOf(surface, loaded);
    if (points.size() * loaded.instances.size() > mostPoints) {
        Box3d box;
        for (const Vec3d& p : points) box.add(p);
        points.clear();
        addCorners(box, {}, points);
    }
    for (const Affine3d& instance : loaded.instances) {
        const Affine3d toWorld = surface.worldFromObject * instance * loaded.objectFromMesh;
        for (const Vec3d& p : points) outline.push_back(toWorld.point(p));
    }
}

constexpr double margin = 0.08;  // of the picture, on every side that is tight

/// From a y-up frame to the one whose up axis is `up`; -z becomes +y.
Vec3d withUp(Vec3d v, UpAxis up) { return up == UpAxis::Z ? Vec3d{v.x, 0 - v.z, v.y} : v; }
Vec3d withoutUp(Vec3d v, UpAxis up) { return up == UpAxis::Z ? Vec3d{v.x, v.z, 0 - v.y} : v; }

/// `v` turned by `degrees` about `axis`, right-handed.
Vec3d turned(Vec3d v, Vec3d axis, double degrees) {
    const Vec3d k = normalize(axis);
    const double c = std::cos(degrees * pi / 180), s = std::sin(degrees * pi / 180);
    return v * c + cross(k, v) * s + k * (dot(k, v) * (1 - c));
}

Box3d boundsOf(const std::vector<Vec3d>& points) {
    Box3d bounds;
    for (const Vec3d& p : points) bounds.add(p);
    return bounds;
}

/// What points span along an axis.
struct Extent {
    double lower = std::numeric_limits<double>::infinity();
    double upper = -std::numeric_limits<double>::infinity();
    void add(double v) { lower = std::min(lower, v), upper = std::max(upper, v); }
    double centre() const { return (lower + upper) / 2; }
};

/// Half the width and height of the picture that are to be filled: at distance 1 (perspective), or
/// of a picture of height 1 (orthographic).
struct HalfPicture {
    double x, y;
    explicit HalfPicture(const SceneDescription& scene) {
        const bool perspective = scene.camera.kind == CameraDescription::Kind::Perspective;
        y = (1 - 2 * margin) * (perspective ? std::tan(scene.camera.fovY * pi / 360) : 0.5);
        x = y * scene.render.width / scene.render.height;
    }
};

/// Where a perspective camera of this picture stands closest with all points in it, in a frame that
/// is turned as the camera is. A point is in it while |p.x - eye.x| <= half.x (eye.z - p.z), and so
/// for y; the tightest points on either side give the planes that meet in the eye.
Vec3d nearestEye(const std::vector<Vec3d>& points, const HalfPicture& half) {
    Extent left, right, below, above;
    for (const Vec3d& p : points) {
        left.add(p.z * half.x - p.x), right.add(p.z * half.x + p.x);
        below.add(p.z * half.y - p.y), above.add(p.z * half.y + p.y);
    }
    return {(right.upper - left.upper) / 2, (above.upper - below.upper) / 2,
            std::max((right.upper + left.upper) / (2 * half.x),
                     (above.upper + below.upper) / (2 * half.y))};
}

/// How far from the origin, on its z axis, such a camera stands closest that looks there.
double nearestDistance(const std::vector<Vec3d>& points, const HalfPicture& half) {
    double distance = 0;
    for (const Vec3d& p : points)
        distance = std::max({distance, p.z + std::abs(p.x) / half.x, p.z + std::abs(p.y) / half.y});
    return distance;
}

/// From the eye that is given.
LookAt lookAtFrom(const SceneDescription& scene, Vec3d target, Vec3d up) {
    const Vec3d eye = *scene.camera.given.eye, view = target - eye;
    const double across = length(cross(normalize(view), normalize(up)));
    if (!(across > 1e-9))
        inPlace(findPlace(scene.places, "camera.eye"), [&] {
            throw inputError(
                "camera.eye looks at the scene's centre, [{:.6g}, {:.6g}, {:.6g}], along up, "
                "[{}, {}, {}], or stands in it; give a look_at or another up",
                target.x, target.y, target.z, up.x, up.y, up.z);
        });
    return {eye, target, up};
}

/// Where along the view from `eye`, as z in a frame that is turned as the camera is, the axis
/// `above` through that frame's origin is passed; 0 where the view goes along it.
double depthOfAxis(const Affine3d& camera, Vec3d eye, Vec3d above) {
    const Vec3d axis = normalize(above), back = camera.column[2];
    const Vec3d across = back - axis * dot(back, axis);
    const double slope = dot(back, across);
    return slope > 1e-6 ? eye.z - dot(camera.vector(eye), across) / slope : 0;
}

/// What the points pass when all is turned about `axis` through `centre`.
std::vector<Vec3d> sweptAbout(const std::vector<Vec3d>& points, Vec3d centre, Vec3d axis) {
    constexpr int turns = 36;
    std::vector<Vec3d> swept;
    for (int i = 0; i < turns; ++i)
        for (const Vec3d& p : points)
            swept.push_back(centre + turned(p - centre, axis, 360.0 * i / turns));
    return swept;
}

/// A view from `towards` that shows all points, unless what is given of the camera asks for
/// another.
LookAt chooseView(const SceneDescription& scene, const std::vector<Vec3d>& points, UpAxis up,
                  Vec3d towards) {
    const PartialPose& given = scene.camera.given;
    const Box3d bounds = boundsOf(points);
    const double size = length(bounds.size());
    const int grain = magnitude(size) - 3;
    const Vec3d above = given.up.value_or(upVector(up));
    if (given.eye) return lookAtFrom(scene, roundTo(bounds.centre(), grain), above);
    if (given.up) {  // the view is told from the axis that is nearer to it
        const UpAxis nearer = std::abs(above.z) > std::abs(above.y) ? UpAxis::Z : UpAxis::Y;
        towards = withUp(withoutUp(towards, up), nearer);
    }
    const Vec3d centre = given.target.value_or(bounds.centre());
    const Affine3d camera = camera::lookAtTransform(towards, {0, 0, 0}, above);
    std::vector<Vec3d> inCamera;
    Extent x, y, z;
    for (const Vec3d& p : points) {
        const Vec3d d = p - centre;
        inCamera.push_back(
            {dot(d, camera.column[0]), dot(d, camera.column[1]), dot(d, camera.column[2])});
        x.add(inCamera.back().x), y.add(inCamera.back().y), z.add(inCamera.back().z);
    }
    Vec3d eye{x.centre(), y.centre(), z.upper + size};
    if (scene.camera.kind == CameraDescription::Kind::Perspective) {
        eye = nearestEye(inCamera, HalfPicture(scene));
        if (given.target) eye.z = nearestDistance(inCamera, HalfPicture(scene));
        eye.z = std::max(eye.z, z.upper + 0.2 * size);  // a wide angle would touch the volume
    }
    if (given.target) {
        eye = {0, 0, std::max(eye.z, 0.2 * size)};
        return {roundTo(centre + camera.vector(eye), grain), centre, above};
    }
    const double depth = scene.camera.orbit ? depthOfAxis(camera, eye, above) : z.centre();
    return {roundTo(centre + camera.vector(eye), grain),
            roundTo(centre + camera.vector({eye.x, eye.y, depth}), grain), above};
}

/// The height of picture that shows all points from where the camera stands.
double chooseHeight(const SceneDescription& scene, const std::vector<Vec3d>& points) {
    const Affine3d cameraFromWorld = worldFromCamera(*scene.camera.pose).inverse();
    const HalfPicture half(scene);
    double height = 0;
    for (const Vec3d& point : points) {
        const Vec3d p = cameraFromWorld.point(point);
        height = std::max({height, std::abs(p.x) / half.x, std::abs(p.y) / half.y});
    }
    return roundTo(height, magnitude(height) - 2);
}

/// Of a camera that a matrix places: the axis of the world that is nearest to upwards in it.
Vec3d axisOf(const Affine3d& pose) {
    const Vec3d above = pose.column[1];
    const bool z = std::abs(above.z) > std::abs(above.y);
    const double sign = (z ? above.z : above.y) < 0 ? -1 : 1;
    return upVector(z ? UpAxis::Z : UpAxis::Y) * sign;
}

}  // namespace

std::vector<Vec3d> sceneOutline(const SceneDescription& description, const LoadedScene& loaded) {
    std::vector<Vec3d> points;
    for (size_t i = 0; i < description.volumes.size(); ++i) {
        const VolumeDescription& volume = description.volumes[i];
        const LoadedVolume& fields = loaded.volumes[i];
        if (const auto* box = std::get_if<HomogeneousBox>(&volume.coefficients))
            addCorners(box->box, volume.worldFromObject, points);
        for (const LoadedField* grid :
             {&fields.density, &fields.sigmaA, &fields.sigmaS, &fields.emission, &fields.blackbody})
            if (*grid)
                addField(*grid->field, volume.worldFromObject * grid->objectFromIndex, points);
    }
    for (size_t i = 0; i < description.surfaces.size(); ++i)
        addSurface(description.surfaces[i], loaded.surfaces[i], points);
    if (points.empty()) addCorners({{0, 0, 0}, {1, 1, 1}}, {}, points);
    return points;
}

std::vector<Vec3d> seenOutline(const SceneDescription& description, const LoadedScene& loaded,
                               Vec3d towards) {
    std::vector<Vec3d> points;
    for (size_t i = 0; i < description.volumes.size(); ++i) {
        const VolumeDescription& volume = description.volumes[i];
        const auto* c = std::get_if<DensityCoefficients>(&volume.coefficients);
        const LoadedField& density = loaded.volumes[i].density;
        if (!c || !c->scale || !density) return sceneOutline(description, loaded);
        addSeen(*density.field, volume.worldFromObject * density.objectFromIndex,
                double{c->scale->mean()}, towards, points);
        for (const LoadedField* grid : {&loaded.volumes[i].emission, &loaded.volumes[i].blackbody})
            if (*grid)
                addField(*grid->field, volume.worldFromObject * grid->objectFromIndex, points);
    }
    for (size_t i = 0; i < description.surfaces.size(); ++i)
        addSurface(description.surfaces[i], loaded.surfaces[i], points);
    return points.empty() ? sceneOutline(description, loaded) : points;
}

Vec3d usualView(UpAxis up, Look look) {
    return withUp(look == Look::Plain ? Vec3d{0.55, 0.35, 1} : Vec3d{0.55, 0.1, 1}, up);
}

Vec3d upVector(UpAxis up) { return withUp({0, 1, 0}, up); }

std::optional<std::string> chooseCamera(SceneDescription& scene, std::vector<Vec3d> points,
                                        UpAxis up, Vec3d towards) {
    CameraDescription& camera = scene.camera;
    const bool fits = camera.height || camera.kind == CameraDescription::Kind::Perspective;
    if (camera.pose && fits) return std::nullopt;
    const Vec3d size = boundsOf(points).size();
    if (!(length(size) > 0 && std::isfinite(length(size))))
        throw inputError(
            "no camera can be chosen for what is {:.3g} x {:.3g} x {:.3g} units large; give a "
            "transform that brings it to another scale",
            size.x, size.y, size.z);
    const bool upIsOpen = !camera.pose && !camera.given.up;
    if (camera.orbit && !camera.pose)
        points = sweptAbout(points, camera.given.target.value_or(boundsOf(points).centre()),
                            camera.given.up.value_or(upVector(up)));
    if (!camera.pose) camera.pose = chooseView(scene, points, up, towards);
    camera.given = {};
    if (!fits) camera.height = chooseHeight(scene, points);
    return fmt::format("chosen to frame the {}{}{}:", scene.surfaces.empty() ? "volumes" : "scene",
                       camera.orbit ? " from all sides" : "",
                       !upIsOpen         ? ""
                       : up == UpAxis::Z ? " (up is +z, as in Blender, which wrote them)"
                                         : " (up is +y)");
}

void turnCamera(CameraDescription& camera, const std::vector<Vec3d>& points) {
    if (!camera.orbit) return;
    const double degrees = *camera.orbit;
    camera.orbit.reset();
    if (auto* pose = std::get_if<LookAt>(&*camera.pose)) {
        pose->eye = pose->target + turned(pose->eye - pose->target, pose->up, degrees);
        return;
    }
    Affine3d& pose = std::get<Affine3d>(*camera.pose);
    const Vec3d axis = axisOf(pose), centre = boundsOf(points).centre();
    for (Vec3d& column : pose.column) column = turned(column, axis, degrees);
    pose.translation = centre + turned(pose.translation - centre, axis, degrees);
}

}  // namespace woodcock::scene
