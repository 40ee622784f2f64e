// SPDX-License-Identifier: Apache-2.0
// Which side light comes from and goes to, shading normals, and what is no scattering.
#include <gtest/gtest.h>

#include "tests/surface/one_bsdf.h"
#include "woodcock/surface/fresnel.h"

namespace woodcock::test {

using namespace surface;

namespace {

std::vector<Material> all(double roughness) {
    ConductorMaterial gold;
    gold.schlick = false;
    gold.eta = Rgb(0.143f, 0.375f, 1.442f), gold.k = Rgb(3.983f, 2.386f, 1.603f);
    gold.roughness = roughness;
    return {diffuse(1),
            whiteMetal(roughness),
            gold,
            glass(roughness),
            InterfaceMaterial{},
            EmissiveMaterial{Rgb(2.0f), false},
            MixMaterial{0, 3, Rgb(0.4f)},
            MixMaterial{2, 4, Rgb(0.6f)},
            MixMaterial{1, 5, Rgb(0.5f)}};
}

Vec3d anyDirection(RandomStream& random) {
    const double z = 2 * random.uniform() - 1;
    return at(z, 2 * pi * random.uniform());
}

TEST(BsdfFuzz, AnythingIsFiniteAndCreatesNoEnergy) {
    const double ends[] = {0, 1e-300, 0x1p-53, 0.5, 1 - 0x1p-53};
    RandomStream random(1);
    const auto number = [&] {
        return random.uniform() < 0.8 ? random.uniform()
                                      : ends[static_cast<int>(random.uniform() * 5)];
    };
    const auto ior = [&] {
        const double change = std::pow(10, -12 * random.uniform());
        return random.uniform() < 0.1 ? 1 : 1 + 2 * change;
    };
    int scattered = 0;
    std::vector<Material> materials;
    double iorOutside = 1, iorInside = 1;
    for (int n = 0; n < 300000; ++n) {
        if (n % 10000 == 0) {  // each roughness and index has tables, which take their time
            materials = all(random.uniform() < 0.2 ? 0.02 + 1e-9 : number());
            iorOutside = ior(), iorInside = ior();
        }
        BsdfPoint point = flatPoint(iorOutside, iorInside);
        point.normal = anyDirection(random);
        point.shadingNormal =
            random.uniform() < 0.5
                ? point.normal
                : normalize(point.normal + anyDirection(random) * (1.2 * random.uniform()));
        const auto index =
            static_cast<std::uint32_t>(random.uniform() * static_cast<double>(materials.size()));
        const Bsdf bsdf(materials, index, point);
        Vec3d s, t;
        orthonormalBasis(point.normal, s, t);
        const double cosine =
            random.uniform() < 0.5
                ? 2 * random.uniform() - 1
                : std::copysign(std::pow(10, -16 * random.uniform()), random.uniform() - 0.5);
        const Vec3d local = at(cosine, 6 * random.uniform());
        const Vec3d out = normalize(s * local.x + t * local.y + point.normal * local.z);
        const BsdfSample drawn = bsdf.sample(out, {number(), number(), number()});
        ASSERT_TRUE(drawn.weight.isFinite() && std::isfinite(drawn.pdf) && drawn.pdf >= 0);
        if (drawn.weight == Rgb()) continue;
        ++scattered;
        const double outside = dot(out, point.normal), inside = dot(drawn.direction, point.normal);
        const double squeeze = !drawn.transmitted || drawn.direction == -out ? 1
                               : outside > 0 ? std::pow(point.iorOutside / point.iorInside, 2)
                                             : std::pow(point.iorInside / point.iorOutside, 2);
        ASSERT_GE(drawn.weight.minimum(), 0);
        ASSERT_LE(double{drawn.weight.maximum()}, squeeze * (1 + 2e-7)) << index << " " << cosine;
        ASSERT_NEAR(length(drawn.direction), 1, 1e-12);
        ASSERT_EQ(drawn.transmitted, inside * outside < 0);
        const Vec3d in = anyDirection(random);
        const BsdfValue value = bsdf.scatter(out, in);
        ASSERT_TRUE(value.value.isFinite() && std::isfinite(value.pdf));
        ASSERT_GE(value.value.minimum(), 0);
    }
    EXPECT_GT(scattered, 200000);
}

/// At silhouettes of coarse meshes the shading normal turns away from the viewer.
TEST(Bsdf, MirrorsAreNotBlackWhereShadingNormalsTurnAway) {
    RandomStream random(2);
    for (int n = 0; n < 10000; ++n) {
        BsdfPoint point = flatPoint(1, 1.5);
        point.shadingNormal = at(random.uniformOpenLow(), 6 * random.uniform());
        const Vec3d out = at(random.uniformOpenLow(), 6 * random.uniform());
        const BsdfSample s = bsdfOf(whiteMetal(0), point).sample(out, {0.5, 0.5, 0.5});
        EXPECT_EQ(s.weight, Rgb(1.0f));
        EXPECT_GT(s.direction.z, 0);
        // Where the mirrored direction is well above the surface, it is the shading normal's.
        const Vec3d mirror = point.shadingNormal * (2 * dot(out, point.shadingNormal)) - out;
        if (mirror.z >= 0.01) {
            EXPECT_NEAR(length(s.direction - mirror), 0, 1e-12);
        }
    }
}

TEST(Bsdf, ShadingNormalsLeakNoLight) {
    RandomStream random(3);
    for (int n = 0; n < 10000; ++n) {
        BsdfPoint point = flatPoint(1, 1.5);
        point.shadingNormal = at(0.2, 6 * random.uniform());
        const Vec3d out = anyDirection(random), in = anyDirection(random);
        for (const Material& material : {diffuse(1), whiteMetal(0.6)})
            EXPECT_TRUE(out.z * in.z > 0 || bsdfOf(material, point).scatter(out, in).pdf == 0);
        // The shading normal colours what is seen: a diffuse point is lit by the cosine to it.
        const double lit = out.z > 0 && in.z > 0 ? std::max(0.0, dot(in, point.shadingNormal)) : 0;
        if (out.z > 0) {
            EXPECT_NEAR(bsdfOf(diffuse(1), point).evaluate(out, in)[0], lit / pi, 1e-6);
        }
    }
}

TEST(Bsdf, PassesWhereNothingChanges) {
    const std::vector<Material> materials{InterfaceMaterial{},
                                          glass(0),
                                          glass(0.5),
                                          diffuse(0.5f),
                                          MixMaterial{0, 1, Rgb(0.3f)},
                                          MixMaterial{0, 3, Rgb(0.3f)},
                                          MixMaterial{0, 3, Rgb(0.0f)},
                                          EmissiveMaterial{}};
    for (const std::uint32_t passing : {0u, 1u, 2u, 4u, 6u}) {
        const Bsdf bsdf(materials, passing, flatPoint(1.5, 1.5));
        EXPECT_TRUE(bsdf.passes()) << passing;
        EXPECT_TRUE(bsdf.transmits());
        EXPECT_FALSE(bsdf.smooth());
        const Vec3d out = at(-0.3, 1);
        const BsdfSample s = bsdf.sample(out, {0.9, 0.5, 0.5});
        EXPECT_TRUE(s.delta && s.transmitted);
        EXPECT_EQ(s.direction, -out);
        EXPECT_EQ(s.weight, Rgb(1.0f));
        EXPECT_EQ(bsdf.straightTransmittance(out), Rgb(1.0f));
        EXPECT_EQ(bsdf.scatter(out, -out).pdf, 0);
    }
    for (const std::uint32_t other : {3u, 5u, 7u})
        EXPECT_FALSE(Bsdf(materials, other, flatPoint(1.5, 1.5)).passes());
    EXPECT_FALSE(Bsdf(materials, 1, flatPoint(1, 1.5)).passes());
    EXPECT_FALSE(Bsdf(materials, 1, flatPoint(1, 1.5)).smooth());
    EXPECT_TRUE(Bsdf(materials, 2, flatPoint(1, 1.5)).smooth());
    EXPECT_TRUE(Bsdf(materials, 1, flatPoint(1, 1.5)).transmits());
    EXPECT_FALSE(Bsdf(materials, 3, flatPoint()).transmits());
    EXPECT_TRUE(Bsdf(materials, 5, flatPoint()).smooth());
}

TEST(Bsdf, EmitsToItsSides) {
    EmissiveMaterial lamp{Rgb(1, 2, 3), false};
    EXPECT_EQ(bsdfOf(lamp).emitted(at(0.1, 1)), Rgb(1, 2, 3));
    EXPECT_EQ(bsdfOf(lamp).emitted(at(-0.1, 1)), Rgb());
    lamp.bothSides = true;
    EXPECT_EQ(bsdfOf(lamp).emitted(at(-0.1, 1)), Rgb(1, 2, 3));
    EXPECT_EQ(bsdfOf(lamp).sample(at(0.5, 1), {0.5, 0.5, 0.5}).weight, Rgb());
    EXPECT_FALSE(bsdfOf(lamp).smooth());
    // The side is the surface's own, whatever its shading normal.
    BsdfPoint point = flatPoint();
    point.shadingNormal = at(0.1, 0);
    lamp.bothSides = false;
    const Vec3d out = at(0.2, pi);
    ASSERT_LT(dot(out, point.shadingNormal), 0);
    EXPECT_EQ(bsdfOf(lamp, point).emitted(out), Rgb(1, 2, 3));
    const Bsdf mix(std::vector<Material>{diffuse(1), lamp, MixMaterial{0, 1, Rgb(0.25f)}}, 2,
                   point);
    EXPECT_EQ(mix.emitted(out), Rgb(0.25f, 0.5f, 0.75f));
}

TEST(Bsdf, MixesByTheMeanOfTheWeight) {
    const std::vector<Material> materials{diffuse(0.5f), whiteMetal(0.7),
                                          MixMaterial{0, 1, Rgb(0.1f, 0.2f, 0.6f)}};
    const Bsdf mix(materials, 2, flatPoint());
    const Vec3d out = at(0.5, 0), in = at(0.4, 3);
    const BsdfValue first = Bsdf(materials, 0, flatPoint()).scatter(out, in);
    const BsdfValue second = Bsdf(materials, 1, flatPoint()).scatter(out, in);
    EXPECT_NEAR(mix.evaluate(out, in)[0], 0.7f * first.value[0] + 0.3f * second.value[0], 1e-6);
    EXPECT_NEAR(mix.pdf(out, in), 0.7 * first.pdf + 0.3 * second.pdf, 1e-6);
    EXPECT_NEAR(mix.albedo()[0], 0.7 * 0.5 + 0.3, 1e-6);
}

/// What a glass plate lets through that absorbs nothing, without reflections inside: T^2.
TEST(Bsdf, StraightTransmittanceOfAPlateIsThatOfTheBentRays) {
    for (const double ior : {1.33, 1.5, 1 / 1.5})
        for (const double cosine : {1.0, 0.5, 0.1}) {
            const Vec3d along = at(-cosine, 1);
            const Bsdf in = bsdfOf(glass(0.3), flatPoint(1, ior)),
                       back = bsdfOf(glass(0.3), flatPoint(ior, 1));
            const double t = 1 - refraction(cosine, ior > 1 ? ior : 1 / ior).reflectance;
            EXPECT_NEAR(in.straightTransmittance(along)[1], t, 1e-6);
            EXPECT_NEAR(back.straightTransmittance(along)[1], t, 1e-6);
        }
    EXPECT_EQ(bsdfOf(diffuse(1)).straightTransmittance({0, 0, 1}), Rgb());
    EXPECT_EQ(bsdfOf(glass(0), flatPoint(1, 1.5)).straightTransmittance({1, 0, 0}), Rgb());
}

TEST(Bsdf, HasTheAlbedoOfItsKind) {
    EXPECT_EQ(bsdfOf(DiffuseMaterial{Rgb(0.1f, 0.2f, 0.3f)}).albedo(), Rgb(0.1f, 0.2f, 0.3f));
    EXPECT_EQ(bsdfOf(glass(0.5), flatPoint(1, 1.5)).albedo(), Rgb(1.0f));
    EXPECT_EQ(bsdfOf(EmissiveMaterial{}).albedo(), Rgb());
    ConductorMaterial metal;
    metal.fresnelColour = Rgb(0.9f, 0.5f, 0.1f);
    EXPECT_EQ(bsdfOf(metal).albedo(), Rgb(0.9f, 0.5f, 0.1f));
    metal.schlick = false;
    metal.eta = Rgb(1.5f), metal.k = Rgb();
    EXPECT_NEAR(bsdfOf(metal).albedo()[0], 0.04, 1e-7);
}

TEST(Bsdf, RefractsBySnellsLaw) {
    for (const double eta : {1.5, 1 / 1.5, 1.0001}) {
        const Vec3d out = at(0.8, 0.3);
        const BsdfSample s = bsdfOf(glass(0), flatPoint(1, eta)).sample(out, {0.999, 0.5, 0.5});
        ASSERT_TRUE(s.transmitted && s.delta);
        EXPECT_NEAR(s.direction.x, -out.x / eta, 1e-15);
        EXPECT_NEAR(s.direction.y, -out.y / eta, 1e-15);
        EXPECT_NEAR(double{s.weight[0]}, 1 / (eta * eta), 1e-6);
    }
}

}  // namespace
}  // namespace woodcock::test
