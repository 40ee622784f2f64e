// SPDX-License-Identifier: Apache-2.0
#include "woodcock/medium/depth_grid.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <vector>

#include "woodcock/medium/line_depths.h"

namespace woodcock::medium {

namespace {

/// How many pieces, each as a voxel, the shortest edge of a homogeneous box is cut into.
constexpr double boxNodes = 32;

/// How many voxels lie from node to node. At 2, pictures are 1.1 to 1.2 times as noisy. At 1, they
/// are no better, and the lattice takes twice as long to make.
constexpr double voxelsToNode = 1.4;
/// And at most.
constexpr double coarsest = 16;
/// What is deeper is stored as this, so that interpolation stays finite.
constexpr double deepestStored = 1e30;
/// Lamps are farther from the box around a medium than this part of its diagonal.
constexpr double nearestLamp = 0.1;

/// The shortest edge of a voxel, in world units; of a medium without fields a part of its shortest
/// edge.
double finestDetail(const Medium& medium) {
    double finest = std::numeric_limits<double>::infinity();
    for (const MediumPart& part : medium.parts) {
        const auto& axes = part.description().worldFromIndex.column;
        for (int i = 0; i < 3; ++i) {
            const double edge = length(axes[static_cast<std::size_t>(i)]);
            finest =
                std::min(finest, part.field() ? edge : edge * part.support().size()[i] / boxNodes);
        }
    }
    return finest;
}

bool bounded(const Medium& medium) {
    if (moves(medium) || medium.worldBounds().empty()) return false;
    return std::ranges::none_of(medium.parts, [](const MediumPart& part) {
        return part.unbounded() || part.extinctionVaries() || part.moved();
    });
}

/// The colour of which the extinctions of all parts are multiples, its largest channel 1; nothing
/// where they are not.
std::optional<Rgb> commonColour(const Medium& medium) {
    std::optional<Rgb> colour;
    for (const MediumPart& part : medium.parts) {
        if (part.field() && part.field()->channels() > 1) return {};
        const float most = part.extinction().maximum();
        if (!(most > 0)) continue;
        const Rgb own = part.extinction() * (1 / most);
        if (colour && *colour != own) return {};
        colour = own;
    }
    return colour.value_or(Rgb(1.0f));
}

}  // namespace

std::unique_ptr<const DepthGrid> DepthGrid::make(const Medium& medium, Vec3d towards,
                                                 std::size_t mostBytes) {
    if (!bounded(medium)) return nullptr;
    std::unique_ptr<DepthGrid> grid(new DepthGrid(medium, medium.worldBounds().lower, towards, 0));
    if (!grid->layOut(mostBytes)) return nullptr;
    return grid;
}

std::unique_ptr<const DepthGrid> DepthGrid::makeForLamp(const Medium& medium, Vec3d lamp,
                                                        double radius, std::size_t mostBytes) {
    if (!bounded(medium)) return nullptr;
    const Box3d box = medium.worldBounds();
    const Vec3d nearest = max(box.lower, min(box.upper, lamp));
    const double away = length(lamp - nearest), size = length(box.size());
    if (!(away - radius > nearestLamp * size)) return nullptr;
    // All of the box is at least as far along this direction.
    const Vec3d towards = (lamp - nearest) * (1 / away);
    const double middle = dot(lamp - box.centre(), towards);
    std::unique_ptr<DepthGrid> grid(new DepthGrid(medium, lamp, towards, middle));
    if (!grid->layOut(mostBytes)) return nullptr;
    const double beside = radius * (size / 2) / middle;  // on the way through half of the medium
    grid->blur_ = static_cast<float>(std::max(1.0, beside / grid->spacing_));
    return grid;
}

DepthGrid::DepthGrid(const Medium& medium, Vec3d origin, Vec3d towards, double middle)
    : medium_(&medium), origin_(origin), towards_(towards), middle_(middle) {
    orthonormalBasis(towards, across_[0], across_[1]);
    const std::optional<Rgb> colour = commonColour(medium);
    channels_ = colour ? 1 : 3;
    if (colour) colour_ = *colour;
}

Vec3d DepthGrid::lightFromWorld(Vec3d world) const {
    const Vec3d p = world - origin_;
    const Vec3d light{dot(p, across_[0]), dot(p, across_[1]), dot(p, towards_)};
    if (!(middle_ > 0)) return light;
    const double scale = middle_ / -light.z;
    return {light.x * scale, light.y * scale, light.z};
}

Vec3d DepthGrid::worldFromLight(Vec3d light) const {
    const double scale = middle_ > 0 ? -light.z / middle_ : 1;
    return origin_ + across_[0] * (light.x * scale) + across_[1] * (light.y * scale) +
           towards_ * light.z;
}

/// False: so much memory is too little.
bool DepthGrid::layOut(std::size_t mostBytes) {
    const double finest = finestDetail(*medium_);
    if (!(finest > 0)) return false;  // a box without thickness
    const Box3d world = medium_->worldBounds();
    Box3d box;  // in light space
    for (int i = 0; i < 8; ++i) box.add(lightFromWorld(world.corner(i)));
    const Vec3d size = box.size();
    // A flat medium has more lines than its volume says.
    const auto cells = [&](int axis) { return std::ceil(size[axis] * (1 + 1e-9) / spacing_); };
    const auto columns = [&](int axis) {
        return std::max(1.0, std::ceil(cells(axis) / columnCells));
    };
    const auto bytes = [&] {
        return columns(0) * columns(1) * columnNodes * columnNodes * (cells(2) + 1) * channels_ *
               sizeof(float);
    };
    constexpr double coarser = 1.1;
    spacing_ = voxelsToNode * finest;
    while (bytes() > static_cast<double>(mostBytes) && spacing_ <= coarsest * finest)
        spacing_ *= coarser;
    if (!(spacing_ <= coarsest * finest)) return false;
    for (int i = 0; i < 2; ++i) columnCount_[i] = static_cast<int>(columns(i));
    length_ = static_cast<int>(std::max(1.0, cells(2))) + 1;
    perSpacing_ = 1 / spacing_;
    base_ = box.lower;
    columns_ = std::make_unique<std::atomic<float*>[]>(static_cast<std::size_t>(columnCount_[0]) *
                                                       static_cast<std::size_t>(columnCount_[1]));
    return true;
}

std::size_t DepthGrid::bytesOfAll() const {
    const auto columns =
        static_cast<std::size_t>(columnCount_[0]) * static_cast<std::size_t>(columnCount_[1]);
    return columns * columnNodes * columnNodes * lineFloats() * sizeof(float);
}

DepthGrid::~DepthGrid() {
    for (int i = 0; i < columnCount_[0] * columnCount_[1]; ++i)
        delete[] columns_[static_cast<std::size_t>(i)].load();
}

DepthGrid::Place DepthGrid::find(Vec3d world) const {
    const Vec3d p = (lightFromWorld(world) - base_) * perSpacing_;
    const auto place = [](double x, int cells, int& cell) {
        const double inside = std::clamp(x, 0.0, static_cast<double>(cells));
        cell = std::min(static_cast<int>(inside), cells - 1);
        return static_cast<float>(inside - cell);
    };
    int i, j, k;
    const float u = place(p.x, columnCount_[0] * columnCells, i);
    const float v = place(p.y, columnCount_[1] * columnCells, j);
    const float w = place(p.z, length_ - 1, k);
    return {nodes(i, j, k), u, v, w};
}

Affine3d DepthGrid::latticeFromWorld() const {
    Vec3d axes[3] = {across_[0], across_[1], towards_};
    double base[3] = {base_.x, base_.y, base_.z};
    if (middle_ > 0)  // the distance of the lamp's plane is -dot(p, towards_)
        for (int i = 0; i < 2; ++i) axes[i] = axes[i] * middle_ + towards_ * base[i], base[i] = 0;
    Affine3d map;
    for (int row = 0; row < 3; ++row) {
        for (std::size_t column = 0; column < 3; ++column)
            map.column[column][row] = axes[row][static_cast<int>(column)] * perSpacing_;
        map.translation[row] = -(dot(axes[row], origin_) + base[row]) * perSpacing_;
    }
    return map;
}

std::array<double, 2> DepthGrid::perspective() const {
    if (!(middle_ > 0)) return {1, 0};
    return {-base_.z, -spacing_};
}

DepthGrid::Depth DepthGrid::read(const Place& place, int channel) const {
    const auto lerp = [](float t, float a, float b) { return a + t * (b - a); };
    const float* n00 = place.node + channel;
    const float *n10 = n00 + lineFloats(), *n01 = n00 + columnNodes * lineFloats(),
                *n11 = n01 + lineFloats();
    const int on = channels_;  // to the next node along
    // Depths fall towards the light.
    const float least = std::min(std::min(n00[on], n10[on]), std::min(n01[on], n11[on])),
                most = std::max(std::max(n00[0], n10[0]), std::max(n01[0], n11[0]));
    const float beside = (blur_ - 1) / 2 * (most - least);
    return {
        lerp(place.v, lerp(place.u, lerp(place.w, n00[0], n00[on]), lerp(place.w, n10[0], n10[on])),
             lerp(place.u, lerp(place.w, n01[0], n01[on]), lerp(place.w, n11[0], n11[on]))),
        std::max(0.0f, least - beside), most + beside};
}

const float* DepthGrid::makeColumn(std::size_t index) const {
    const std::lock_guard lock(making_[index % making_.size()]);
    if (const float* made = columns_[index].load(std::memory_order_acquire)) return made;
    const std::size_t floats = lineFloats() * columnNodes * columnNodes;
    auto nodes = std::make_unique<float[]>(floats);
    const auto across = static_cast<std::size_t>(columnCount_[0]);
    const auto first = static_cast<double>(index % across * columnCells);
    const auto second = static_cast<double>(index / across * columnCells);
    for (int j = 0; j < columnNodes; ++j)
        for (int i = 0; i < columnNodes; ++i)
            fillLine(first + i, second + j,
                     &nodes[static_cast<std::size_t>(j * columnNodes + i) * lineFloats()]);
    bytesMade_ += floats * sizeof(float);
    columns_[index].store(nodes.get(), std::memory_order_release);
    return nodes.release();
}

/// The nodes of one line: first the depth of each step, then their sums from the far end. A step
/// is integrated by two points, which is quick and good enough for what is corrected.
void DepthGrid::fillLine(double i, double j, float* nodes) const {
    const int steps = length_ - 1;
    const auto node = [&](int k) {
        return worldFromLight(base_ + Vec3d{i, j, static_cast<double>(k)} * spacing_);
    };
    const Vec3d start = node(0), step = node(1) - start;
    const double spacing = length(step);
    std::vector<double> depth(static_cast<std::size_t>(length_ * channels_));
    for (const MediumPart& part : medium_->parts) {
        const Rgb sigma = channels_ == 1 ? Rgb(part.extinction().maximum()) : part.extinction();
        integrateSteps(part, part.indexRay(start, step * (1 / spacing)), steps, spacing, channels_,
                       [&](int k, int c, double integral) {
                           depth[static_cast<std::size_t>(k * channels_ + c)] +=
                               integral * double{sigma[c]};
                       });
    }
    for (int c = 0; c < channels_; ++c) {
        double sum = 0;
        for (int k = steps; k >= 0; --k) {
            const auto at = static_cast<std::size_t>(k * channels_ + c);
            sum += depth[at];
            nodes[at] = static_cast<float>(std::min(sum, deepestStored));
        }
    }
}

}  // namespace woodcock::medium
