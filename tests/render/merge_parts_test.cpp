// SPDX-License-Identifier: Apache-2.0
#include "woodcock/render/merge_parts.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "tests/support/expect_error.h"
#include "woodcock/base/temp_dir.h"
#include "woodcock/image/write_exr.h"
#include "woodcock/proof/support/render_scene.h"
#include "woodcock/render/saved_state.h"
#include "woodcock/render/tile_order.h"

namespace woodcock::test {

using namespace image;
using namespace proof;
using namespace render;

namespace {

namespace fs = std::filesystem;
constexpr Film::Window picture{0, 0, 61, 40};

Scene fogBeforeSky() {
    return sceneFrom(
        "[[volume]]\nbox = { min = [-1, -1, -1], max = [1, 1, 1] }\nsigma_s = [1, 2, 0.5]\n"
        "sigma_a = 0.1\n[[light]]\ntype = \"sun\"\ndirection = [1, -2, 0]\n"
        "[[light]]\ntype = \"environment\"\nradiance = 0.3\n"
        "[camera]\neye = [0, 0.5, 5]\nlook_at = [0, 0, 0]\nfov = 40\n");
}

RenderSettings settings(int first, int end) {
    RenderSettings s;
    s.width = picture.x1, s.height = picture.y1;
    s.firstSample = first, s.endSample = end;
    s.layers.features = true;
    return s;
}

/// Mattes and deep pixels, too.
RenderSettings compositing(int first, int end) {
    RenderSettings s = settings(first, end);
    s.mattes = {{"CryptoObject", {"fog"}, {0}}};
    s.deepError = 0.02;
    return s;
}

class MergeParts : public testing::Test {
protected:
    fs::path part(const std::string& name, const RenderSettings& s,
                  const StateFacts& facts = {{"scene", "0123"}, {"files", "4567"}},
                  const Scene* other = nullptr) const {
        const RenderResult result = render::render(other ? *other : scene, s);
        const SavedState saved(
            result, s, s.height == picture.y1 ? picture : Film::Window{0, 0, s.width, s.height},
            endingOf(result.reason), facts);
        writeExr(dir / name, result.film, {}, {}, &saved.filmState());
        return dir / name;
    }
    const Scene scene = fogBeforeSky();
    const TempDir dir;
};

bool withinOneUlp(float a, float b) {
    constexpr float inf = std::numeric_limits<float>::infinity();
    return a >= std::nextafter(b, -inf) && a <= std::nextafter(b, inf);
}
void expectWithinOneUlp(Rgb a, Rgb b, const char* what) {
    for (int c = 0; c < 3; ++c)
        EXPECT_TRUE(withinOneUlp(a[c], b[c])) << what << ": " << a[c] << ", " << b[c];
}

/// All that files show. Where all samples of a pixel are alike, as those of a plain sky are, their
/// variance is the rounding of sums: some 1e-16 of the squares.
void expectSamePictures(const Film& a, const Film& b) {
    ASSERT_TRUE(a.isLike(b));
    const Film::Window w = a.crop();
    for (int y = w.y0; y < w.y1; ++y)
        for (int x = w.x0; x < w.x1; ++x) {
            ASSERT_EQ(a.at(x, y).samples, b.at(x, y).samples) << x << ", " << y;
            expectWithinOneUlp(a.radiance(x, y), b.radiance(x, y), "radiance");
            expectWithinOneUlp(Rgb(a.alpha(x, y)), Rgb(b.alpha(x, y)), "alpha");
            expectWithinOneUlp(Rgb(a.depth(x, y)), Rgb(b.depth(x, y)), "depth");
            expectWithinOneUlp(a.transmittance(x, y), b.transmittance(x, y), "transmittance");
            expectWithinOneUlp(a.albedo(x, y), b.albedo(x, y), "albedo");
            const Vec3f n = a.normal(x, y), m = b.normal(x, y);
            expectWithinOneUlp({n.x, n.y, n.z}, {m.x, m.y, m.z}, "normal");
            const Rgb error = a.standardError(x, y);
            const Rgb light = a.radiance(x, y);
            if (error[0] > 1e-6f * light[0])
                expectWithinOneUlp(error, b.standardError(x, y), "error");
            else
                EXPECT_LE(b.standardError(x, y)[0], 1e-6f * light[0]);
        }
    EXPECT_NEAR(a.noise(), b.noise(), 1e-12);
}

void expectSameCompositing(const RenderResult& whole, const MergedParts& merged) {
    for (int y = picture.y0; y < picture.y1; ++y)
        for (int x = picture.x0; x < picture.x1; ++x) {
            const std::uint64_t n = whole.film.at(x, y).samples;
            std::array<float, 2 * matteRanks> a, b;
            whole.mattes->ranks(0, x, y, n, a), merged.mattes->ranks(0, x, y, n, b);
            EXPECT_EQ(a[0], b[0]);
            EXPECT_TRUE(withinOneUlp(a[1], b[1])) << a[1] << ", " << b[1];
            const std::vector<DeepSample> one = whole.deep->samples(x, y, whole.film),
                                          other = merged.deep->samples(x, y, merged.film);
            ASSERT_EQ(one.size(), other.size()) << x << ", " << y;
            for (std::size_t i = 0; i < one.size(); ++i) {
                EXPECT_EQ(one[i].near, other[i].near);
                EXPECT_EQ(one[i].far, other[i].far);
                EXPECT_TRUE(withinOneUlp(one[i].alpha, other[i].alpha));
                expectWithinOneUlp(one[i].colour, other[i].colour, "deep");
            }
        }
}

TEST_F(MergeParts, SampleRangesAndTilesAreOneRender) {
    const RenderResult whole = render::render(scene, compositing(0, 22));
    std::vector<fs::path> files;
    for (int tile = 0; tile < 6; ++tile)
        for (const auto& [first, end] : {std::pair(0, 9), std::pair(9, 22)}) {
            RenderSettings s = compositing(first, end);
            s.crop = pictureTile(picture, tile, 6);
            files.push_back(part("t" + std::to_string(files.size()) + ".exr", s));
        }
    std::swap(files.front(), files.back());
    const MergedParts merged = mergeParts(files, {.spp = 22});
    expectSamePictures(whole.film, merged.film);
    expectSameCompositing(whole, merged);
    EXPECT_EQ(merged.firstSample, 0);
    EXPECT_EQ(merged.endSample, 22);
    EXPECT_EQ(merged.seeds, std::vector<std::uint64_t>{0});
    EXPECT_TRUE(merged.missing.empty());
}

TEST_F(MergeParts, RefusesOtherMattesAndOtherBins) {
    const fs::path a = part("a.exr", compositing(0, 2)), plain = part("p.exr", settings(2, 4));
    RenderSettings s = compositing(2, 4);
    s.mattes[0].names[0] = "smoke";
    const fs::path named = part("n.exr", s);
    s = compositing(2, 4);
    s.crop = Film::Window{10, 10, 40, 30};
    const fs::path fitting = part("f.exr", s);
    const Scene denser = sceneFrom(
        "[[volume]]\nbox = { min = [-1, -1, -1], max = [1, 1, 1] }\nsigma_s = 5\n"
        "[[light]]\ntype = \"environment\"\n"
        "[camera]\neye = [0, 0.5, 5]\nlook_at = [0, 0, 0]\nfov = 40\n");
    const fs::path other = part("o.exr", s, {{"scene", "0123"}, {"files", "4567"}}, &denser);
    const auto refused = [](const std::string& said, const std::vector<fs::path>& files) {
        expectError(ErrorKind::Input, said, [&] { mergeParts(files, {.partial = true}); });
    };
    refused(
        "were sampled for different layers: depth and features, CryptoObject, deep pixels of "
        "error 0.02 and depth and features",
        {a, plain});
    refused("have different names of mattes: ", {a, named});
    refused("a.exr' and '" + other.string() + "' have deep pixels with different bins, first at ",
            {a, other});
    EXPECT_NO_THROW(mergeParts({a, fitting}, {.partial = true}));
}

/// A pixel's mean is that of all its samples, whichever render drew them.
TEST_F(MergeParts, AdaptiveRendersOfSeveralSeedsWeighBySamples) {
    std::vector<fs::path> files;
    std::vector<Film> films;
    for (const std::uint64_t seed : {1u, 2u, 3u}) {
        RenderSettings s = settings(0, 24);
        s.seed = seed, s.adaptive = true;
        films.push_back(render::render(scene, s).film);
        files.push_back(part(std::to_string(seed) + ".exr", s));
    }
    const MergedParts merged = mergeParts(files, {});
    EXPECT_TRUE(merged.adaptive);
    EXPECT_EQ(merged.endSample, 72);
    EXPECT_EQ(merged.seeds, (std::vector<std::uint64_t>{1, 2, 3}));
    for (int y = 0; y < picture.y1; ++y)
        for (int x = 0; x < picture.x1; ++x) {
            double sum = 0, samples = 0;
            for (const Film& film : films) {
                const auto n = static_cast<double>(film.at(x, y).samples);
                sum += n * double{film.radiance(x, y)[1]}, samples += n;
            }
            EXPECT_NEAR(merged.film.radiance(x, y)[1], sum / samples, 1e-6 * sum / samples);
            EXPECT_EQ(static_cast<double>(merged.film.at(x, y).samples), samples);
        }
}

TEST_F(MergeParts, RefusesWhatDoesNotFit) {
    const fs::path a = part("a.exr", settings(0, 4));
    const auto refuse = [&](const std::string& message, const fs::path& other) {
        expectError(ErrorKind::Input, message, [&] { mergeParts({a, other}, {}); });
    };
    RenderSettings s = settings(4, 8);
    refuse("are of different scenes: their digests are 0123 and 89ab",
           part("b.exr", s, {{"scene", "89ab"}, {"files", "4567"}}));
    refuse("are of scenes whose files differ: their digests are 4567 and 0",
           part("c.exr", s, {{"scene", "0123"}, {"files", "0"}}));
    s.layers.features = false;
    refuse("were sampled for different layers: depth and features and light", part("d.exr", s));
    s = settings(4, 8);
    s.width = 50, s.height = 30;
    refuse("are parts of different pixels: 0,0,61,40 and 0,0,50,30", part("e.exr", s));
    refuse("both hold samples 2:4 of all pixels (seed 0)", part("f.exr", settings(2, 8)));
    expectError(ErrorKind::Usage, "is named twice", [&] { mergeParts({a, dir / "./a.exr"}, {}); });
    const fs::path g = part("g.exr", settings(6, 8));
    refuse("samples 4:6 of all pixels are missing (seed 0)", g);
    const MergedParts merged = mergeParts({a, g}, {.partial = true});
    EXPECT_EQ(merged.missing.size(), 1u);
    EXPECT_EQ(merged.film.fewestSamples(), 6u);
}

}  // namespace
}  // namespace woodcock::test
