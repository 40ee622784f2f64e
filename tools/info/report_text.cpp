// SPDX-License-Identifier: Apache-2.0
#include <fmt/core.h>

#include <algorithm>
#include <cmath>

#include "tools/info/report.h"
#include "woodcock/base/printable.h"

namespace woodcock::tool {

namespace {

/// 1963736 -> "1,963,736"
std::string grouped(std::uint64_t n) {
    std::string s = std::to_string(n);
    for (std::size_t i = s.size(); i > 3; i -= 3) s.insert(i - 3, 1, ',');
    return s;
}

std::string counted(std::uint64_t n, const std::string& what) {
    return fmt::format("{} {}{}", grouped(n), what, n == 1 ? "" : "s");
}

std::string memory(std::uintmax_t bytes) {
    const auto b = static_cast<double>(bytes);
    if (b < 1024) return fmt::format("{} B", bytes);
    if (b < 1024 * 1024) return fmt::format("{:.1f} KiB", b / 1024);
    if (b < 1024.0 * 1024 * 1024) return fmt::format("{:.1f} MiB", b / (1024 * 1024));
    return fmt::format("{:.2f} GiB", b / (1024.0 * 1024 * 1024));
}

std::string vec(Vec3d v) { return fmt::format("[{:.6g}, {:.6g}, {:.6g}]", v.x, v.y, v.z); }
/// Coordinates that are far from the origin as voxels count have the digits that tell these apart.
std::string place(Vec3d v, Vec3d voxel) {
    const double away = std::max({std::abs(v.x), std::abs(v.y), std::abs(v.z)});
    const double side = std::min({voxel.x, voxel.y, voxel.z});
    const int digits =
        away > 1e4 * side && side > 0 ? std::min(17, 3 + int(std::log10(away / side))) : 6;
    return fmt::format("[{:.{}g}, {:.{}g}, {:.{}g}]", v.x, digits, v.y, digits, v.z, digits);
}
std::string vec(Vec3i v) { return fmt::format("[{}, {}, {}]", v.x, v.y, v.z); }

template <class T>
std::string value(const std::array<T, 3>& v, int channels) {
    if (channels == 1) return fmt::format("{:.6g}", v[0]);
    return fmt::format("[{:.6g}, {:.6g}, {:.6g}]", v[0], v[1], v[2]);
}

class GridText {
public:
    explicit GridText(const grid::GridInfo& info) : info_(info), grid_(info.listing) {
        text_ = fmt::format("\n  {}  {}, {}\n", grid_.uniqueName, grid_.valueType,
                            grid_.gridClass == grid::GridClass::Unknown
                                ? "no class"
                                : grid::gridClassName(grid_.gridClass));
        describeTransform();
        if (info.contents) describeContents(*info.contents);
        describeMetadata();
        for (const std::string& remark : info.remarks) text_ += fmt::format("    ! {}\n", remark);
        if (!info.error.empty()) text_ += "    ! its voxels cannot be read\n";
    }
    std::string take() { return std::move(text_); }

private:
    void line(const std::string& label, const std::string& content) {
        text_ += fmt::format("    {:<11}{}\n", label, content);
    }

    void describeTransform() {
        if (!grid_.worldFromIndex) {
            line("transform", grid_.frustum ? "frustum" : "unreadable");
            return;
        }
        const Affine3d& m = *grid_.worldFromIndex;
        const Vec3d size = grid_.voxelSize;
        if (m.column == Affine3d::scale(size).column) {
            line("voxel size",
                 size.x == size.y && size.y == size.z ? fmt::format("{:.6g}", size.x) : vec(size));
            line("origin", place(m.translation, size));
            return;
        }
        line("voxel size", vec(size));
        for (int row = 0; row < 3; ++row)
            line(row == 0 ? "transform" : "",
                 fmt::format("[{:>12.6g} {:>12.6g} {:>12.6g} {:>12.6g} ]", m.column[0][row],
                             m.column[1][row], m.column[2][row], m.translation[row]));
    }

    void describeContents(const grid::GridInfo::Contents& contents) {
        const grid::GridStatistics& statistics = contents.statistics;
        const grid::VoxelScan& voxels = statistics.voxels;
        const Box3i& box = statistics.activeBounds;
        std::string share;
        if (!box.empty()) {
            const Vec3d size = (box.upper.as<double>() - box.lower.as<double>()) + Vec3d{1, 1, 1};
            line("bounds", fmt::format("{} to {}, {:.0f} x {:.0f} x {:.0f} voxels", vec(box.lower),
                                       vec(box.upper), size.x, size.y, size.z));
            share =
                fmt::format(" ({:.3g} % of the bounds)",
                            100 * static_cast<double>(voxels.active) / (size.x * size.y * size.z));
        }
        if (contents.worldBounds)
            line("in world",
                 fmt::format("{} to {}, {:.6g} x {:.6g} x {:.6g} units",
                             place(contents.worldBounds->lower, grid_.voxelSize),
                             place(contents.worldBounds->upper, grid_.voxelSize),
                             contents.worldBounds->size().x, contents.worldBounds->size().y,
                             contents.worldBounds->size().z));
        line("active",
             fmt::format(
                 "{}{}, with {} and {}", counted(voxels.active, "voxel"), share,
                 counted(statistics.activeTiles, "tile"),
                 statistics.leaves == 1 ? "1 leaf" : grouped(statistics.leaves) + " leaves"));
        const std::string background =
            fmt::format("background {}", value(statistics.background, grid_.channels));
        if (voxels.finite == 0)
            line("values", background);
        else
            line("values",
                 fmt::format("{} to {}, mean {}, {}", value(voxels.min, grid_.channels),
                             value(voxels.max, grid_.channels),
                             value(std::array{voxels.mean(0), voxels.mean(1), voxels.mean(2)},
                                   grid_.channels),
                             background));
        line("memory",
             fmt::format("{}{} in OpenVDB, {} in Woodcock ({})",
                         grid_.fileBytes ? memory(grid_.fileBytes) + " in the file, " : "",
                         memory(statistics.openVdbBytes), memory(contents.fieldBytes),
                         contents.fieldStorage == grid::Storage::Half ? "half" : "float"));
        if (contents.majorants)
            line("majorants",
                 fmt::format("{:.3g} segments per ray, mean majorant {:.3g} x the mean value "
                             "(at an optical depth of {:g})",
                             contents.majorants->segmentsPerRay,
                             contents.majorants->majorantOverMean, grid::GridInfo::opticalDepth));
    }

    void describeMetadata() {
        std::size_t width = 0;
        for (const auto& [key, text] : grid_.metadata) width = std::max(width, key.size());
        bool first = true;
        for (const auto& [key, text] : grid_.metadata) {
            line(first ? "metadata" : "",
                 fmt::format("{:<{}}  {}", printable(key), width, printable(text)));
            first = false;
        }
    }

    const grid::GridInfo& info_;
    const grid::GridListing& grid_;
    std::string text_;
};

}  // namespace

bool FileInfo::sound() const {
    return error.empty() && std::all_of(grids.begin(), grids.end(), [](const grid::GridInfo& grid) {
               return grid.error.empty();
           });
}

std::string infoText(const FileInfo& file) {
    std::string text = fmt::format("{}  {}, {}, {}\n", file.path.string(), file.version,
                                   memory(file.bytes), counted(file.grids.size(), "grid"));
    if (!file.warning.empty()) text += fmt::format("    ! {}\n", file.warning);
    if (file.grids.empty()) text += "    ! it holds nothing to be drawn\n";
    for (const grid::GridInfo& grid : file.grids) text += GridText(grid).take();
    return text + "\n";
}

}  // namespace woodcock::tool
