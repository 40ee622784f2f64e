// SPDX-License-Identifier: Apache-2.0
#include "woodcock/render/part_coverage.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <set>
#include <tuple>

namespace woodcock::render {

namespace {

using Window = image::Film::Window;

/// Pixels that share a fault.
struct Pixels {
    std::uint64_t count = 0;
    Window box{};

    void add(const Window& w) {
        box = count == 0 ? w
                         : Window{std::min(box.x0, w.x0), std::min(box.y0, w.y0),
                                  std::max(box.x1, w.x1), std::max(box.y1, w.y1)};
        count += areaOf(w);
    }
    std::string text(const Window& picture) const {
        if (box == picture && count == areaOf(box)) return "all pixels";
        return fmt::format("{} pixels in {},{},{},{}", count, box.x0, box.y0, box.x1, box.y1);
    }
    static std::uint64_t areaOf(const Window& w) {
        return static_cast<std::uint64_t>(w.width()) * static_cast<std::uint64_t>(w.height());
    }
};

/// The parts of one seed.
class Seed {
public:
    Seed(std::vector<const PartCoverage*> parts, std::uint32_t spp)
        : parts_(std::move(parts)), spp_(spp), end_(spp) {
        std::sort(parts_.begin(), parts_.end(), [](const auto* a, const auto* b) {
            return std::tie(a->first, a->name) < std::tie(b->first, b->name);
        });
        for (const PartCoverage* part : parts_) end_ = std::max(end_, part->asked);
    }

    /// Rectangles whose pixels have the same parts are looked at as one, if all of these end
    /// evenly.
    void look(const Window& picture) {
        std::set<int> columns{picture.x0, picture.x1}, rows{picture.y0, picture.y1};
        for (const PartCoverage* part : parts_) {
            columns.insert({part->window.x0, part->window.x1});
            rows.insert({part->window.y0, part->window.y1});
        }
        for (auto y = rows.begin(); std::next(y) != rows.end(); ++y)
            for (auto x = columns.begin(); std::next(x) != columns.end(); ++x)
                lookAt({*x, *y, *std::next(x), *std::next(y)});
    }

    void tell(const Window& picture, CoverageFaults& faults) const {
        const std::string of = fmt::format("seed {}", parts_.front()->seed);
        for (const auto& [what, pixels] : doubled_) {
            const auto& [a, b, first, end] = what;
            faults.doubled.push_back(fmt::format("'{}' and '{}' both hold samples {}:{} of {} ({})",
                                                 a, b, first, end, pixels.text(picture), of));
        }
        for (const auto& [range, pixels] : missing_)
            faults.missing.push_back(
                range.second == 0
                    ? fmt::format("all samples of {} are missing ({})", pixels.text(picture), of)
                    : fmt::format("samples {}:{} of {} are missing ({})", range.first, range.second,
                                  pixels.text(picture), of));
    }

private:
    void lookAt(const Window& cell) {
        std::vector<const PartCoverage*> here;
        for (const PartCoverage* part : parts_)
            if (part->window.x0 <= cell.x0 && part->window.y0 <= cell.y0 &&
                part->window.x1 >= cell.x1 && part->window.y1 >= cell.y1)
                here.push_back(part);
        if (std::all_of(here.begin(), here.end(),
                        [](const PartCoverage* part) { return part->drawn.empty(); }))
            return lookAtAlike(cell, here);
        for (int y = cell.y0; y < cell.y1; ++y)
            for (int x = cell.x0; x < cell.x1; ++x) lookAtAlike({x, y, x + 1, y + 1}, here);
    }

    /// All pixels of `cell` have the same samples.
    void lookAtAlike(const Window& cell, const std::vector<const PartCoverage*>& here) {
        std::uint32_t reached = 0;
        bool open = false;  // the last part ended where a limit was
        const PartCoverage* before = nullptr;
        for (const PartCoverage* part : here) {
            const std::uint32_t end = endOf(*part, cell.x0, cell.y0);
            if (end == part->first) continue;
            if (part->first < reached)
                doubled_[{before->name, part->name, part->first, std::min(reached, end)}].add(cell);
            if (part->first > reached) missing_[{reached, part->first}].add(cell);
            if (end > reached) reached = end, before = part, open = part->asked == 0;
        }
        if (reached == 0 && end_ == 0) missing_[{0, 0}].add(cell);
        if (reached < end_ && !(open && reached >= spp_)) missing_[{reached, end_}].add(cell);
    }

    static std::uint32_t endOf(const PartCoverage& part, int x, int y) {
        if (part.drawn.empty()) return part.end;
        return part.drawn[static_cast<std::size_t>(y - part.window.y0) *
                              static_cast<std::size_t>(part.window.width()) +
                          static_cast<std::size_t>(x - part.window.x0)];
    }

    std::vector<const PartCoverage*> parts_;
    std::uint32_t spp_, end_;
    std::map<std::tuple<std::string, std::string, std::uint32_t, std::uint32_t>, Pixels> doubled_;
    std::map<std::pair<std::uint32_t, std::uint32_t>, Pixels> missing_;
};

}  // namespace

CoverageFaults findFaults(const std::vector<PartCoverage>& parts, Window picture,
                          std::uint32_t spp) {
    std::map<std::uint64_t, std::vector<const PartCoverage*>> bySeed;
    for (const PartCoverage& part : parts) bySeed[part.seed].push_back(&part);
    CoverageFaults faults;
    for (auto& [seed, ofSeed] : bySeed) {
        Seed coverage(std::move(ofSeed), spp);
        coverage.look(picture);
        coverage.tell(picture, faults);
    }
    return faults;
}

}  // namespace woodcock::render
