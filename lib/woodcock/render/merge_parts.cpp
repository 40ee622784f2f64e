// SPDX-License-Identifier: Apache-2.0
#include "woodcock/render/merge_parts.h"

#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <climits>
#include <map>

#include "woodcock/base/error.h"
#include "woodcock/base/memory.h"
#include "woodcock/base/printable.h"
#include "woodcock/base/whole_file.h"
#include "woodcock/render/part_coverage.h"
#include "woodcock/render/saved_state.h"

namespace woodcock::render {

namespace {

using image::StateFile;
using Window = image::Film::Window;

/// Facts that parts of one picture share, and what a message calls them.
struct SharedFact {
    const char* name;
    const char* what;
};
constexpr std::array sharedFacts{
    SharedFact{"scene", "are of different scenes: their digests are"},
    SharedFact{"files", "are of scenes whose files differ: their digests are"},
    SharedFact{"picture", "are parts of different pixels:"},
    SharedFact{"sampled", "were sampled for different layers:"},
    SharedFact{"mattes", "have different names of mattes:"}};

void checkLikeFirst(const StateFile& first, const StateFile& other) {
    const auto refuse = [&](const std::string& why) {
        return inputError("'{}' and '{}' {}", first.file().string(), other.file().string(), why);
    };
    for (const SharedFact& fact : sharedFacts)
        if (first.fact(fact.name) != other.fact(fact.name))
            throw refuse(fmt::format("{} {} and {}", fact.what, shown(first.fact(fact.name)),
                                     shown(other.fact(fact.name))));
    if (first.width() != other.width() || first.height() != other.height())
        throw refuse(fmt::format("are of different sizes: {} x {} and {} x {}", first.width(),
                                 first.height(), other.width(), other.height()));
    const auto sums = [](const StateFile& file) {
        return image::Film(1, 1, {0, 0, 1, 1}, image::Film::keptIn(file.planes()));
    };
    if (!sums(first).isLike(sums(other)) ||
        image::DeepState::isIn(first) != image::DeepState::isIn(other))
        throw refuse("keep different sums");
}

std::vector<StateFile> openParts(const std::vector<std::filesystem::path>& files) {
    std::vector<StateFile> parts;
    for (auto file = files.begin(); file != files.end(); ++file) {
        for (auto before = files.begin(); before != file; ++before)
            if (sameFile(*before, *file)) throw usageError("'{}' is named twice", file->string());
        parts.emplace_back(*file, "part");
        checkLikeFirst(parts.front(), parts.back());
    }
    return parts;
}

PartCoverage coverageOf(const StateFile& file, const RenderState& state) {
    PartCoverage part{.name = file.file().string(), .window = file.window()};
    part.seed = static_cast<std::uint64_t>(file.count("seed", 0, INT64_MAX));
    part.first = static_cast<std::uint32_t>(file.count("first", 0, INT_MAX));
    const auto [fewest, most] = std::minmax_element(state.drawn.begin(), state.drawn.end());
    part.end = *most;
    if (*fewest < *most) part.drawn = state.drawn;
    // How many samples an adaptive render takes of a pixel is its own to say.
    if (file.fact("adaptive") == "no" && endingOf(file) != Ending::Limited)
        part.asked = static_cast<std::uint32_t>(file.count("asked", part.first, INT_MAX));
    return part;
}

/// The sums of a part, a Film or a MatteFilm, whose crop lies within that of `whole`.
template <typename SomeFilm>
void addPart(SomeFilm& whole, const SomeFilm& part) {
    const std::vector<image::Film::Plane> to = whole.planes();
    const std::vector<image::Film::ConstPlane> from = part.planes();
    const Window w = part.crop(), all = whole.crop();
    for (std::size_t i = 0; i < to.size(); ++i) {
        const auto add = [&](auto* sums, const auto* more) {
            std::size_t source = 0;
            for (int y = w.y0; y < w.y1; ++y) {
                const std::size_t row =
                    static_cast<std::size_t>(y - all.y0) * static_cast<std::size_t>(all.width()) +
                    static_cast<std::size_t>(w.x0 - all.x0);
                for (std::size_t x = 0; x < static_cast<std::size_t>(w.width()); ++x, ++source)
                    for (std::size_t c = 0; c < static_cast<std::size_t>(to[i].components); ++c)
                        sums[(row + x) * to[i].stride + c] += more[source * from[i].stride + c];
            }
        };
        to[i].sums ? add(to[i].sums, from[i].sums) : add(to[i].counts, from[i].counts);
    }
}

/// The deep pixels of parts: films with the same crop are added at once, others at the end, when
/// the bins of all pixels are known.
class DeepParts {
public:
    /// Throws Error{Input} where the bins differ from those of a part before.
    void add(const std::string& name, image::DeepFilm part) {
        image::DeepFilm* like = nullptr;
        for (std::size_t i = 0; i < films_.size(); ++i) {
            if (const auto pixel = films_[i].mismatch(part))
                throw inputError(
                    "'{}' and '{}' have deep pixels with different bins, first at {}, {}: another "
                    "version of woodcock, or another machine, may have made one of them",
                    names_[i], name, (*pixel)[0], (*pixel)[1]);
            if (films_[i].crop() == part.crop()) like = &films_[i];
        }
        if (like) return like->add(part);
        films_.push_back(std::move(part));
        names_.push_back(name);
    }

    std::optional<image::DeepFilm> all(const Window& picture) && {
        if (films_.empty()) return std::nullopt;
        if (films_.size() == 1 && films_.front().crop() == picture)
            return std::move(films_.front());
        return image::DeepFilm(picture, films_);
    }

private:
    std::vector<image::DeepFilm> films_;
    std::vector<std::string> names_;  // of the first part of each
};

std::string joined(const std::vector<std::string>& sentences) {
    constexpr std::size_t most = 20;
    std::string text;
    for (std::size_t i = 0; i < std::min(sentences.size(), most); ++i)
        text += (i ? "\n" : "") + sentences[i];
    if (sentences.size() > most) text += fmt::format("\nand {} more", sentences.size() - most);
    return text;
}

/// What every pixel has of a seed, or an adaptive render has done.
struct Reached {
    int first = INT_MAX, end = 0;
};

}  // namespace

MergedParts mergeParts(const std::vector<std::filesystem::path>& files,
                       const MergeSettings& settings) {
    const std::vector<StateFile> parts = openParts(files);
    const StateFile& first = parts.front();
    const Window picture = pictureOf(first);
    const image::Film::Kept kept = image::Film::keptIn(first.planes());
    std::vector<image::MatteLayer> mattes = matteLayersIn(first);
    const double needed = 2.0 * picture.width() * picture.height() *
                          (static_cast<double>(image::Film::bytesPerPixel(kept)) +
                           image::MatteFilm::bytesPerPixel(mattes));
    if (const auto possible = static_cast<double>(memoryLimit()); needed > possible)
        throw failure("the parts need {} of memory, and there are {}", formatGiB(needed),
                      formatGiB(possible));

    MergedParts merged{image::Film(first.width(), first.height(), picture, kept)};
    if (!mattes.empty()) merged.mattes.emplace(picture, std::move(mattes));
    DeepParts deep;
    std::vector<PartCoverage> coverage;
    std::vector<std::string> unfinished;
    std::map<std::uint64_t, Reached> reached;
    for (const StateFile& file : parts) {
        RenderState state = readState(file);
        addPart(merged.film, state.film);
        if (merged.mattes) addPart(*merged.mattes, *state.mattes);
        if (state.deep) deep.add(file.file().string(), std::move(*state.deep));
        const PartCoverage& part = coverage.emplace_back(coverageOf(file, state));
        const bool adaptive = file.fact("adaptive") == "yes";
        merged.adaptive |= adaptive;
        if (adaptive && endingOf(file) == Ending::Unfinished)
            unfinished.push_back(fmt::format("'{}' was interrupted", part.name));
        merged.seconds += state.seconds;
        if (std::find(merged.seeds.begin(), merged.seeds.end(), part.seed) == merged.seeds.end())
            merged.seeds.push_back(part.seed);
        Reached& r = reached[part.seed];
        r.first = std::min(r.first, static_cast<int>(part.first));
        r.end = std::max(r.end, state.endSample);
    }

    CoverageFaults faults =
        findFaults(coverage, picture, static_cast<std::uint32_t>(settings.spp.value_or(0)));
    if (!faults.doubled.empty())
        throw inputError("the parts overlap, and a sample counts once:\n{}",
                         joined(faults.doubled));
    merged.missing = std::move(faults.missing);
    merged.missing.insert(merged.missing.end(), unfinished.begin(), unfinished.end());
    if (!merged.missing.empty() && !settings.partial)
        throw inputError("the parts are not all:\n{}\n--partial merges what is there",
                         joined(merged.missing));
    merged.deep = std::move(deep).all(picture);
    std::int64_t samples = 0;
    for (const auto& [seed, r] : reached) samples += r.end - r.first;
    merged.firstSample = reached.size() == 1 ? reached.begin()->second.first : 0;
    merged.endSample =
        static_cast<int>(std::min<std::int64_t>(merged.firstSample + samples, INT_MAX));
    return merged;
}

}  // namespace woodcock::render
