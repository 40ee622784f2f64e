// SPDX-License-Identifier: Apache-2.0
#include "woodcock/image/film_state.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <limits>
#include <random>

#include "tests/support/expect_error.h"
#include "tests/support/same_films.h"
#include "woodcock/base/temp_dir.h"
#include "woodcock/image/read_layers.h"
#include "woodcock/image/write_exr.h"

namespace woodcock::test {

using namespace image;

namespace {

constexpr Film::Window crop{3, 2, 40, 29};
constexpr Film::Kept everything{.surfaces = true, .features = true, .background = true};

/// Sums of all magnitudes that doubles have, and none in some pixels.
Film randomFilm(Film::Kept kept = everything) {
    Film film(50, 31, crop, kept);
    std::mt19937_64 random(5);
    for (const Film::Plane& plane : film.planes())
        for (std::size_t p = 0; p < film.pixelCount(); ++p)
            for (std::size_t c = 0; c < static_cast<std::size_t>(plane.components); ++c) {
                const std::size_t at = p * plane.stride + c;
                if (p % 7 == 0 || plane.name == "depthWeight") continue;
                if (plane.counts)
                    plane.counts[at] = random() >> (random() % 64);
                else
                    plane.sums[at] = std::ldexp(std::generate_canonical<double, 53>(random),
                                                static_cast<int>(random() % 2100) - 1074);
            }
    return film;
}

class FilmStates : public testing::Test {
protected:
    std::filesystem::path write(const Film& film, const StateFacts& facts = {{"scene", "abc"}}) {
        const FilmState state{facts, film.width(), film.height(), film.crop(),
                              std::as_const(film).planes()};
        writeExr(dir / "a.exr", film, {}, {}, &state);
        return dir / "a.exr";
    }
    static Film read(const std::filesystem::path& path) {
        const StateFile file(path, "checkpoint");
        Film film(file.width(), file.height(), file.window(), Film::keptIn(file.planes()));
        file.read(film.planes());
        return film;
    }
    const TempDir dir;
};

TEST_F(FilmStates, ComeBackToTheLastBit) {
    for (const Film::Kept& kept : {everything, Film::Kept{false, false, false}}) {
        const Film film = randomFilm(kept);
        expectSameBits(film, read(write(film)));
    }
    const Film empty(50, 31, crop);
    expectSameBits(empty, read(write(empty)));
}

TEST_F(FilmStates, TellTheirFacts) {
    const StateFile file(write(randomFilm(), {{"seed", "42"}, {"ratio", "-1.5e3"}, {"empty", ""}}),
                         "checkpoint");
    EXPECT_EQ(file.fact("empty"), "");
    EXPECT_EQ(file.count("seed", 0, 42), 42);
    EXPECT_EQ(file.number("ratio"), -1500);
    EXPECT_FALSE(file.has("scene"));
    expectError(ErrorKind::Input, "it does not tell its 'scene'", [&] { file.fact("scene"); });
    expectError(ErrorKind::Input, "its 'seed' is '42', not a number from 0 to 41",
                [&] { file.count("seed", 0, 41); });
    expectError(ErrorKind::Input, "its 'empty' is '', not a number", [&] { file.number("empty"); });
}

/// What shows images shows the first part, and comparisons leave the sums out.
TEST_F(FilmStates, LieBehindThePicture) {
    Film film(50, 31, crop);
    film.add(5, 5, FilmSample{Rgb(1, 2, 3), 0.5f});
    ExrSettings settings;
    settings.layers = layersFromNames({"depth"});
    writeExr(dir / "plain.exr", film, {}, settings);
    const FilmState state{{}, 50, 31, crop, std::as_const(film).planes()};
    writeExr(dir / "kept.exr", film, {}, settings, &state);
    const LayeredImage plain = readLayers(dir / "plain.exr"), kept = readLayers(dir / "kept.exr");
    ASSERT_EQ(plain.planes.size(), kept.planes.size());
    for (std::size_t i = 0; i < plain.planes.size(); ++i) {
        EXPECT_EQ(plain.planes[i].name(), kept.planes[i].name());
        EXPECT_EQ(plain.planes[i].values, kept.planes[i].values);
    }
}

TEST_F(FilmStates, ArePartsOfEXRFilesAlone) {
    const Film film = randomFilm();
    writeExr(dir / "plain.exr", film, {}, {});
    expectError(ErrorKind::Input, "it keeps no sums, only a picture",
                [&] { StateFile(dir / "plain.exr", "part"); });
    writeText(dir / "text.exr", "no picture");
    expectError(ErrorKind::Input, "cannot read part", [&] { StateFile(dir / "text.exr", "part"); });
    expectError(ErrorKind::Input, "cannot read part 'none.exr'",
                [&] { StateFile("none.exr", "part"); });
}

/// A damaged file is refused, or read as it was: damage may meet the picture.
TEST_F(FilmStates, DamageIsSeen) {
    const Film film = randomFilm();
    const std::string whole = readText(write(film));
    std::mt19937 random(3);
    int refused = 0;
    for (int i = 0; i < 300; ++i) {
        std::string bytes = whole;
        if (i % 10 == 0)
            bytes.resize(random() % bytes.size());
        else
            bytes[random() % bytes.size()] ^= static_cast<char>(1 << random() % 8);
        writeText(dir / "damaged.exr", bytes);
        try {
            expectSameBits(film, read(dir / "damaged.exr"));
        } catch (const Error& e) {
            EXPECT_EQ(e.kind(), ErrorKind::Input) << e.what();
            ++refused;
        }
    }
    EXPECT_GT(refused, 200);  // most bytes are those of sums
}

TEST_F(FilmStates, AreWrittenWholeOrNotAtAll) {
    const Film film = randomFilm();
    write(film, {{"scene", "first"}});
    const FilmState state{{}, 50, 31, crop, film.planes()};
    expectError(ErrorKind::Failure, "cannot write",
                [&] { writeExr(dir / "none/a.exr", film, {}, {}, &state); });
    EXPECT_EQ(StateFile(dir / "a.exr", "checkpoint").fact("scene"), "first");
}

}  // namespace
}  // namespace woodcock::test
