// SPDX-License-Identifier: Apache-2.0
#include "woodcock/render/camera_depths.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "woodcock/camera/projection.h"
#include "woodcock/medium/corrected_transmittance.h"
#include "woodcock/medium/line_depths.h"
#include "woodcock/render/media_table.h"

namespace woodcock::render {

namespace {

/// How many of the finest voxels lie from node to node, where the memory allows it; and at most.
/// With 2, fire is 1.08 times dearer, and media alone 1.02 times.
constexpr double voxelsBetweenNodes = 1.4, mostVoxelsBetweenNodes = 16;
/// Small media have at least so many nodes along their diagonal: their voxels are coarse.
constexpr double fewestNodes = 80;
/// Memory that all lines may take: so much, or a quarter of the medium's fields.
constexpr std::size_t mostLineBytes = 64u << 20;
/// Media deeper than this, across, have none. At 31 and 32, they make a grey and a coloured medium
/// 1.06 to 1.3 times cheaper; at 63 and more, 1.1 to 1.4 times dearer.
constexpr double deepest = 50;

bool canHaveLines(const Scene& scene) {
    const auto& parts = scene.medium.parts;
    return !parts.empty() && parts.size() <= CameraDepths::mostParts && !scene.camera.motion &&
           std::ranges::all_of(parts, [](const medium::MediumPart& part) {
               return part.field() && part.field()->channels() == 1 && !part.unbounded() &&
                      !part.extinctionVaries() && !part.moved() && !part.readElsewhere() &&
                      !part.description().movement && !part.support().empty();
           });
}

double finestVoxel(const medium::Medium& medium) {
    double finest = std::numeric_limits<double>::infinity();
    for (const medium::MediumPart& part : medium.parts)
        for (const Vec3d& axis : part.description().worldFromIndex.column)
            finest = std::min(finest, length(axis));
    return finest;
}

std::size_t bytesOfFields(const medium::Medium& medium) {
    std::size_t bytes = 0;
    for (const medium::MediumPart& part : medium.parts) bytes += part.field()->bytes();
    return bytes;
}

}  // namespace

std::unique_ptr<const CameraDepths> CameraDepths::make(const Scene& scene, int width, int height) {
    if (!canHaveLines(scene) || depthAcross(MediumSummary(scene.medium)) > deepest) return nullptr;
    std::unique_ptr<CameraDepths> depths(new CameraDepths(scene, width, height));
    if (!depths->layOut()) return nullptr;
    return depths;
}

CameraDepths::CameraDepths(const Scene& scene, int width, int height)
    : scene_(scene), rays_(scene.camera, width, height), width_(width), height_(height) {}

bool CameraDepths::layOut() {
    const Box3d box = scene_.medium.worldBounds();
    const bool perspective = scene_.camera.kind == camera::Camera::Kind::Perspective;
    const Vec3d eye = scene_.camera.worldFromCamera.translation;
    const Vec3d forward = rays_.at(width_ / 2.0, height_ / 2.0).direction;
    double x1 = 0, y1 = 0, nearest = 1e300, farthest = 0;
    x0_ = width_, y0_ = height_;
    for (int i = 0; i < 8; ++i) {
        const Vec3d corner = box.corner(i);
        const auto at = camera::pixelOf(scene_.camera, corner, width_, height_);
        const double distance = perspective ? length(corner - eye) : dot(corner - eye, forward);
        if (!at || !(distance > 0)) return false;
        x0_ = std::min(x0_, (*at)[0]), x1 = std::max(x1, (*at)[0]);
        y0_ = std::min(y0_, (*at)[1]), y1 = std::max(y1, (*at)[1]);
        nearest = std::min(nearest, distance), farthest = std::max(farthest, distance);
    }
    if (perspective) nearest = length(max(box.lower, min(box.upper, eye)) - eye);
    x0_ = std::clamp(x0_, 0.0, width_ * 1.0), x1 = std::clamp(x1, 0.0, width_ * 1.0);
    y0_ = std::clamp(y0_, 0.0, height_ * 1.0), y1 = std::clamp(y1, 0.0, height_ * 1.0);
    if (!(x1 > x0_ && y1 > y0_ && nearest > 0)) return false;
    const double middle = (nearest + farthest) / 2;
    const auto place = [&](double x) {
        const camera::CameraRay ray = rays_.at(x, height_ / 2.0);
        return ray.origin + ray.direction * middle;
    };
    const double pixel = length(place(width_ / 2.0 + 1) - place(width_ / 2.0));
    const double finest = std::min(finestVoxel(scene_.medium),
                                   length(box.size()) / (fewestNodes * voxelsBetweenNodes));
    const auto most =
        static_cast<double>(std::max(mostLineBytes, bytesOfFields(scene_.medium) / 4));
    constexpr double coarser = 1.1;
    near_ = nearest;
    const auto nodes = [](double size, double step) { return std::ceil(size / step) + 1; };
    for (double voxels = voxelsBetweenNodes; voxels <= mostVoxelsBetweenNodes; voxels *= coarser) {
        spacing_ = voxels * finest, step_ = spacing_ / pixel;
        if (step_ > std::min(width_, height_)) return false;
        const double across = nodes(x1 - x0_, step_), down = nodes(y1 - y0_, step_),
                     along = nodes(farthest - nearest, spacing_);
        if (2 * across * down * along * sizeof(float) *
                static_cast<double>(scene_.medium.parts.size()) >
            most)
            continue;
        across_ = std::max(2, static_cast<int>(across)),
        down_ = std::max(2, static_cast<int>(down));
        steps_ = std::max(1, static_cast<int>(along) - 1);
        const double coarse = voxels / voxelsBetweenNodes;
        rarestCorrection_ = static_cast<float>(
            std::min(1.0 / 32, double{medium::rarestCorrection} * coarse * coarse));
        lines_ = std::make_unique<std::atomic<float*>[]>(lineCount());
        return true;
    }
    return false;
}

/// Those of the lattice, by rows; then those in the middle of four, by rows.
std::size_t CameraDepths::lineCount() const {
    if (across_ == 0) return 0;  // nothing could be laid out
    const auto across = static_cast<std::size_t>(across_), down = static_cast<std::size_t>(down_);
    return across * down + (across - 1) * (down - 1);
}

double CameraDepths::bytesAtMost() const {
    return static_cast<double>(lineCount()) *
           (sizeof(float*) +
            sizeof(float) * (steps_ + 1.0) * static_cast<double>(scene_.medium.parts.size()));
}

double bytesOfCameraDepths(const Scene& scene, int width, int height) {
    const auto depths = scene.surfaces ? nullptr : CameraDepths::make(scene, width, height);
    return depths ? depths->bytesAtMost() : 0;
}

CameraDepths::~CameraDepths() {
    for (std::size_t i = 0; i < lineCount(); ++i) delete[] lines_[i].load();
}

CameraDepths::Ray CameraDepths::at(double x, double y) const {
    const auto find = [&](double at, int lines, std::size_t& first) {
        const double inside = std::clamp(at / step_, 0.0, lines - 1.0);
        const int cell = std::min(static_cast<int>(inside), lines - 2);
        first = static_cast<std::size_t>(cell);
        return static_cast<float>(inside - cell - 0.5);
    };
    std::size_t i, j;
    const float u = find(x - x0_, across_, i), v = find(y - y0_, down_, j);
    const auto across = static_cast<std::size_t>(across_), down = static_cast<std::size_t>(down_);
    const std::size_t first = j * across + i;
    const float* of[2][2];  // by v, u
    for (std::size_t k = 0; k < 4; ++k)
        of[k >> 1][k & 1] = line(first + (k >> 1) * across + (k & 1));
    const bool alongV = std::abs(u) >= std::abs(v);  // the nearest side
    const float away = alongV ? std::abs(u) : std::abs(v), along = alongV ? v : u;
    const std::size_t side = (alongV ? u : v) > 0;
    Ray ray{{},
            line(across * down + j * (across - 1) + i),
            {away - along, away + along, 1 - 2 * away},
            scene_.medium.parts.size()};
    for (std::size_t k = 0; k < 4; ++k) {
        const std::size_t at = k < 2 ? side : 1 - side, end = k & 1;
        ray.lines[k] = alongV ? of[end][at] : of[at][end];
    }
    return ray;
}

const float* CameraDepths::line(std::size_t index) const {
    const float* made = lines_[index].load(std::memory_order_acquire);
    return made ? made : makeLine(index);
}

const float* CameraDepths::makeLine(std::size_t index) const {
    const std::lock_guard lock(making_[index % making_.size()]);
    if (const float* made = lines_[index].load(std::memory_order_acquire)) return made;
    auto nodes = std::make_unique<float[]>(static_cast<std::size_t>(steps_ + 1) *
                                           scene_.medium.parts.size());
    const auto across = static_cast<std::size_t>(across_), down = static_cast<std::size_t>(down_);
    const bool middle = index >= across * down;
    const std::size_t place = middle ? index - across * down : index,
                      row = middle ? across - 1 : across;
    const double shift = middle ? 0.5 : 0;
    fill(x0_ + (static_cast<double>(place % row) + shift) * step_,
         y0_ + (static_cast<double>(place / row) + shift) * step_, nodes.get());
    lines_[index].store(nodes.get(), std::memory_order_release);
    return nodes.release();
}

void CameraDepths::fill(double x, double y, float* nodes) const {
    const camera::CameraRay ray = rays_.at(x, y);
    const std::size_t parts = scene_.medium.parts.size();
    std::vector<double> steps(static_cast<std::size_t>(steps_));
    for (std::size_t p = 0; p < parts; ++p) {
        const medium::MediumPart& part = scene_.medium.parts[p];
        std::ranges::fill(steps, 0.0);
        medium::integrateSteps(
            part, part.indexRay(ray.origin + ray.direction * near_, ray.direction), steps_,
            spacing_, 1,
            [&](int k, int, double integral) { steps[static_cast<std::size_t>(k)] += integral; });
        double sum = 0;
        for (std::size_t k = 0; k <= steps.size(); ++k) {
            nodes[k * parts + p] = static_cast<float>(sum);
            if (k < steps.size()) sum += steps[k];
        }
    }
}

}  // namespace woodcock::render
