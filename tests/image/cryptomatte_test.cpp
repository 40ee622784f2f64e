// SPDX-License-Identifier: Apache-2.0
#include "woodcock/image/cryptomatte.h"

#include <gtest/gtest.h>

#include "tests/support/decode_cryptomatte.h"
#include "tests/support/paths.h"
#include "woodcock/image/write_cryptomatte.h"

namespace woodcock::test {

using namespace image;
using namespace proof;

namespace {

struct Vector {
    const char* name;
    std::uint32_t hash, bits;
    double value;
};
/// The first two are examples of the specification; the next ones are of its manifest. Two more
/// have an exponent of 0 and of 255.
const std::vector<Vector> vectors{{"torus", 4053562365u, 0xf19c73fd, -1.54943625e+30},
                                  {"равнина", 2518896926u, 0x9623511e, -1.31926312e-25},
                                  {"hello", 613153351u, 0x248bfa47, 6.07056271e-17},
                                  {"bunny", 327490166u, 0x13851a76, 3.36000126e-27},
                                  {"default", 1120495519u, 0x42c9679f, 100.702385},
                                  {"smoke", 3011245360u, 0xb37bf530, -5.86634883e-08},
                                  {"cloud", 2724419853u, 0xa263590d, -3.08113797e-18},
                                  {"volume19", 0x8067bf2cu, 0x80e7bf2c, -2.12825792e-38},
                                  {"volume166", 0xff9b4855u, 0xff1b4855, -2.06405909e+38}};

TEST(Cryptomatte, IdsAreThoseOfTheSpecification) {
    for (const Vector& v : vectors) {
        EXPECT_EQ(murmur3(v.name), v.hash) << v.name;
        EXPECT_EQ(matteBits(v.name), v.bits) << v.name;
        EXPECT_NEAR(matteId(v.name) / v.value, 1, 1e-8) << v.name;
    }
}

TEST(Cryptomatte, IdsOfAnyNameAreTheHashOrAnOrdinaryFloatNextToIt) {
    for (int i = 0; i < 2000; ++i) {
        const std::string name = "object/" + std::to_string(i * 7919);
        const std::uint32_t hash = murmur3(name), bits = matteBits(name);
        EXPECT_TRUE(bits == hash || bits == (hash ^ 0x800000u)) << name;
        EXPECT_TRUE(std::isnormal(matteId(name))) << name;
        if (std::isnormal(std::bit_cast<float>(hash))) {
            EXPECT_EQ(bits, hash) << name;
        }
    }
}

TEST(Cryptomatte, HeaderHasTheKeyOfTheLayersName) {
    const auto attributes = matteAttributes({"CryptoObject", {"bunny", "default"}, {}});
    const std::vector<std::pair<std::string, std::string>> expected{
        {"cryptomatte/3ae39a5/name", "CryptoObject"},
        {"cryptomatte/3ae39a5/hash", "MurmurHash3_32"},
        {"cryptomatte/3ae39a5/conversion", "uint32_to_float32"},
        {"cryptomatte/3ae39a5/manifest", R"({"bunny":"13851a76","default":"42c9679f"})"}};
    EXPECT_EQ(attributes, expected);
    EXPECT_EQ(matteAttributes({"CryptoMaterial", {}, {}})[0].first, "cryptomatte/be359d6/name");
    EXPECT_EQ(matteAttributes({"CryptoAsset", {}, {}})[0].first, "cryptomatte/f42029d/name");
    EXPECT_EQ(matteChannels({"CryptoObject", {}, {}}),
              (std::vector<std::string>{
                  "CryptoObject00.r", "CryptoObject00.g", "CryptoObject00.b", "CryptoObject00.a",
                  "CryptoObject01.r", "CryptoObject01.g", "CryptoObject01.b", "CryptoObject01.a",
                  "CryptoObject02.r", "CryptoObject02.g", "CryptoObject02.b", "CryptoObject02.a"}));
}

/// Two samples of one pixel: what each owner stops.
MatteFilm filmOf(std::size_t names, const std::vector<std::pair<std::uint32_t, double>>& stopped) {
    MatteLayer layer{"CryptoObject", {}, {}};
    for (std::size_t i = 0; i < names; ++i) {
        layer.names.push_back("thing " + std::to_string(i));
        layer.nameOf.push_back(static_cast<std::uint32_t>(i));
    }
    MatteFilm film({4, 7, 5, 8}, {layer});
    StoppedLight ray;
    for (const auto& [owner, amount] : stopped)
        ray.stops.push_back({.near = 1, .far = 1, .before = amount, .after = 0, .owner = owner});
    film.add(4, 7, ray);
    film.add(4, 7, {});
    return film;
}

TEST(Cryptomatte, RanksFallByCoverageAndTheRestIsLeftOut) {
    const TempDir dir;
    // In halves, of two samples: seven things, of which a file keeps six.
    const MatteFilm mattes =
        filmOf(8, {{0, 0.05}, {1, 0.3}, {2, 0.04}, {3, 0.2}, {5, 0.02}, {6, 0.1}, {7, 0.06}});
    Film film(9, 9, {4, 7, 5, 8});
    film.add(4, 7, FilmSample{});
    film.add(4, 7, FilmSample{});
    writeCryptomatte(dir / "m.exr", mattes, film, {});
    const ReadBack image = readBack(dir / "m.exr");
    for (const auto& [channel, type] : image.types) EXPECT_EQ(type, "float") << channel;
    const CryptomatteDecoder decoder(image, "CryptoObject");
    EXPECT_EQ(decoder.ids().size(), 8u);
    std::vector<std::pair<float, float>> ranks;
    decoder.forEachRank(4, 7, [&](float id, float c) { ranks.emplace_back(id, c); });
    const std::vector<std::pair<int, double>> expected{{1, 0.15}, {3, 0.1},   {6, 0.05},
                                                       {7, 0.03}, {0, 0.025}, {2, 0.02}};
    ASSERT_EQ(ranks.size(), expected.size());
    for (std::size_t i = 0; i < ranks.size(); ++i) {
        EXPECT_EQ(ranks[i].first, decoder.ids().at("thing " + std::to_string(expected[i].first)));
        EXPECT_FLOAT_EQ(ranks[i].second, static_cast<float>(expected[i].second));
    }
}

TEST(Cryptomatte, WhereNothingIsIdsAre0) {
    const MatteFilm mattes = filmOf(2, {});
    std::vector<float> ranks(12, 5.0f);
    mattes.ranks(0, 4, 7, 2, ranks);
    EXPECT_EQ(ranks, std::vector<float>(12));
}

TEST(Cryptomatte, NamesOfAllKindsStayJson) {
    const std::string odd = "a \"b\" \\ π\n{}";
    const auto manifest = matteAttributes({"CryptoObject", {odd}, {}}).back().second;
    const auto json = nlohmann::json::parse(manifest);
    EXPECT_EQ(std::stoul(json.at(odd).get<std::string>(), nullptr, 16), matteBits(odd));
}

}  // namespace

}  // namespace woodcock::test
