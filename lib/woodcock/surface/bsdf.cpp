// SPDX-License-Identifier: Apache-2.0
#include "woodcock/surface/bsdf.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include "woodcock/base/random.h"
#include "woodcock/surface/fresnel.h"
#include "woodcock/surface/microfacet.h"

namespace woodcock::surface {

/// The point as seen from direction `out`: all normals are on that side.
struct Bsdf::View {
    Vec3d out;
    Vec3d normal, shading;  ///< the surface's own, and the interpolated one
    Vec3d facing;       ///< the mean normal of the facets: `shading`, or that bent towards `out`
    Vec3d s, t;         ///< complete `facing` to a frame
    Vec3d local;        ///< `out` in that frame, above its horizon
    double cosine = 0;  ///< of `out` to `normal`; at most 0: the point cannot be seen
    double iorHere = 1,
           eta = 1;       ///< index of refraction on this side; that of the other side over it
    bool outside = true;  ///< this is the side of the surface's own normal

    Vec3d toFacets(Vec3d v) const { return {dot(v, s), dot(v, t), dot(v, facing)}; }
    Vec3d fromFacets(Vec3d v) const { return s * v.x + t * v.y + facing * v.z; }
    /// Whether `in` is on the side of `out` (or on the other one) by the surface's own normal and
    /// by the facing normal. Where the two disagree light would leak.
    bool reflects(Vec3d in) const { return dot(in, normal) > 0 && dot(in, facing) > 0; }
    bool transmits(Vec3d in) const { return dot(in, normal) < 0 && dot(in, facing) < 0; }
};

/// f |cos| = pdf x ratio. No ratio exceeds one, but for the squared index of refraction. So no lobe
/// creates energy, and none divides by a small density.
struct Bsdf::Density {
    double pdf = 0;
    Rgb ratio;
};

namespace {

Vec3d mirrored(Vec3d v, Vec3d normal) { return normal * (2 * dot(v, normal)) - v; }

/// The shading normal, bent by the least that keeps the mirrored `out` above the surface. Otherwise
/// silhouettes of coarse meshes would be black. Keller et al. 2017, "The Iray Light Transport
/// Simulation and Rendering System", appendix A.3. `cosine`: of `out` to the surface's own normal.
Vec3d bent(Vec3d out, Vec3d normal, Vec3d shading, double cosine) {
    const double least = std::min(0.9 * cosine, 0.01);
    const Vec3d mirror = mirrored(out, shading);
    const double above = dot(mirror, normal);
    if (above >= least) return shading;
    const Vec3d along = mirror - normal * above;
    if (!(length(along) > 1e-6)) return normal;
    return normalize(out + normal * least + normalize(along) * std::sqrt(1 - least * least));
}

Vec3d refracted(Vec3d out, Vec3d normal, double cosine, double cosineBeyond, double eta) {
    return normalize(normal * (cosine / eta - cosineBeyond) - out / eta);
}

/// A direction in proportion to its cosine to the normal.
Vec3d aroundNormal(Vec3d normal, double u0, double u1) {
    const double sine = std::sqrt(u0), phi = 2 * pi * u1;
    Vec3d s, t;
    orthonormalBasis(normal, s, t);
    return normalize(s * (sine * std::cos(phi)) + t * (sine * std::sin(phi)) +
                     normal * std::sqrt(1 - u0));
}

/// GGX's alpha is the square of the roughness (Burley 2012).
double alphaOf(double roughness) {
    return roughness < Bsdf::leastRoughness ? 0 : roughness * roughness;
}

}  // namespace

Bsdf::Bsdf(std::span<const Material> materials, std::uint32_t index, const BsdfPoint& point)
    : point_(point) {
    if (!(dot(point.shadingNormal, point.normal) > 0)) point_.shadingNormal = point.normal;
    if (const auto* mix = std::get_if<MixMaterial>(&materials[index])) {
        const double second = std::clamp(double{mix->weight.at(point.u, point.v).mean()}, 0.0, 1.0);
        add(materials[mix->first], 1 - second);
        add(materials[mix->second], second);
    } else {
        add(materials[index], 1);
    }
}

void Bsdf::add(const Material& material, double weight) {
    if (!(weight > 0) || std::holds_alternative<MixMaterial>(material)) return;
    Lobe& lobe = lobes_[static_cast<std::size_t>(count_++)];
    lobe.weight = weight;
    if (const auto* diffuse = std::get_if<DiffuseMaterial>(&material)) {
        lobe.kind = Lobe::Kind::Diffuse;
        lobe.colour = diffuse->colour.at(point_.u, point_.v);
    } else if (const auto* metal = std::get_if<ConductorMaterial>(&material)) {
        lobe.kind = Lobe::Kind::Conductor;
        lobe.schlick = metal->schlick;
        if (metal->schlick) lobe.colour = metal->fresnelColour.at(point_.u, point_.v);
        lobe.eta = metal->eta, lobe.k = metal->k;
        lobe.alpha = alphaOf(metal->roughness);
        if (lobe.alpha > 0) {
            lobe.energy = &facetEnergy(lobe.alpha, 0);
            // Light that meets further facets, each of which absorbs a part: Hill 2018, "A
            // Multi-Faceted Exploration", part 3, after Kulla and Conty.
            const Rgb f = meanFresnel(lobe, point_.iorOutside);
            const auto kept = static_cast<float>(1 - lobe.energy->outside.mean());
            lobe.again =
                Rgb::map([&](int c) { return f[c] * f[c] * kept / (1 - f[c] * (1 - kept)); });
        }
    } else if (const auto* glass = std::get_if<DielectricMaterial>(&material)) {
        const double change = std::abs(point_.iorInside / point_.iorOutside - 1);
        if (change > 0) lobe.kind = Lobe::Kind::Dielectric;
        // With less bending than this the density of transmitted light would overflow a float.
        if (change > 1e-5) lobe.alpha = alphaOf(glass->roughness);
        if (lobe.alpha > 0)
            lobe.energy = &facetEnergy(lobe.alpha, point_.iorInside / point_.iorOutside);
    } else if (const auto* light = std::get_if<EmissiveMaterial>(&material)) {
        lobe.kind = Lobe::Kind::Emissive;
        lobe.colour = light->radiance.at(point_.u, point_.v);
        lobe.bothSides = light->bothSides;
    }
    if (lobe.scatters()) scattering_ += weight;
}

bool Bsdf::passes() const {
    return count_ > 0 && std::all_of(lobes().begin(), lobes().end(), [](const Lobe& lobe) {
               return lobe.kind == Lobe::Kind::Pass;
           });
}

bool Bsdf::smooth() const {
    return std::any_of(lobes().begin(), lobes().end(),
                       [](const Lobe& lobe) { return lobe.scatters() && !lobe.delta(); });
}

bool Bsdf::transmits() const {
    return std::any_of(lobes().begin(), lobes().end(), [](const Lobe& lobe) {
        return lobe.kind == Lobe::Kind::Dielectric || lobe.kind == Lobe::Kind::Pass;
    });
}

Bsdf::View Bsdf::viewFrom(Vec3d out) const {
    View view;
    const bool outside = dot(out, point_.normal) > 0;
    view.out = out;
    view.normal = outside ? point_.normal : -point_.normal;
    view.shading = outside ? point_.shadingNormal : -point_.shadingNormal;
    view.cosine = dot(out, view.normal);
    view.outside = outside;
    view.iorHere = outside ? point_.iorOutside : point_.iorInside;
    view.eta = (outside ? point_.iorInside : point_.iorOutside) / view.iorHere;
    if (!(view.cosine > 0)) return view;
    view.facing = bent(out, view.normal, view.shading, view.cosine);
    orthonormalBasis(view.facing, view.s, view.t);
    view.local = view.toFacets(out);
    view.local.z = std::max(view.local.z, 1e-300);  // rounding may take it below
    return view;
}

Rgb Bsdf::fresnel(const Lobe& lobe, double cosine, double ior) {
    if (lobe.schlick) return schlickReflectance(cosine, lobe.colour);
    return Rgb::map([&](int c) {
        return static_cast<float>(
            conductorReflectance(cosine, double{lobe.eta[c]} / ior, double{lobe.k[c]} / ior));
    });
}

/// Mean Fresnel reflectance of light from all around, by Gauss-Legendre quadrature in the cosine;
/// within 1e-5 for metals.
Rgb Bsdf::meanFresnel(const Lobe& lobe, double ior) {
    if (lobe.schlick) return lobe.colour + (Rgb(1.0f) - lobe.colour) * (1 / 21.0f);
    constexpr double nodes[] = {0.966234757102, 0.830604693233, 0.619309593042,
                                0.380690406958, 0.169395306767, 0.033765242898};
    constexpr float weights[] = {0.165539679280f, 0.299650255712f, 0.289783588399f,
                                 0.178130346174f, 0.061111317336f, 0.005784813100f};
    Rgb sum;
    for (int i = 0; i < 6; ++i) sum += fresnel(lobe, nodes[i], ior) * weights[i];
    return Rgb::map([&](int c) { return std::min(sum[c], 1.0f); });
}

Bsdf::Density Bsdf::diffuse(const Lobe& lobe, const View& view, Vec3d in) {
    const double cosine = dot(in, view.shading);
    if (!(cosine > 0) || !(dot(in, view.normal) > 0)) return {};
    return {cosine / pi, lobe.colour};
}

/// Light that leaves after more than one facet: the share that the first one loses, spread in
/// proportion to what is lost in the other direction.
Bsdf::Density Bsdf::again(const Lobe& lobe, const View& view, Vec3d in) {
    const FacetEnergy& energy = *lobe.energy;
    const bool metal = lobe.kind == Lobe::Kind::Conductor;
    const FacetLosses& here = metal || view.outside ? energy.outside : energy.inside;
    const double lost = here.lost(view.local.z);
    if (metal) {
        if (!view.reflects(in)) return {};
        return {lost * here.density(dot(in, view.facing)), lobe.again};
    }
    const double back = view.outside ? energy.backOutside : energy.backInside;
    if (view.reflects(in)) return {lost * back * here.density(dot(in, view.facing)), Rgb(1.0f)};
    if (!view.transmits(in)) return {};
    const FacetLosses& beyond = view.outside ? energy.inside : energy.outside;
    return {lost * (1 - back) * beyond.density(-dot(in, view.facing)),
            Rgb(static_cast<float>(1 / (view.eta * view.eta)))};
}

Bsdf::Density Bsdf::conductor(const Lobe& lobe, const View& view, Vec3d in) {
    if (lobe.alpha == 0 || !view.reflects(in)) return {};
    const Ggx facets(lobe.alpha);
    const Vec3d o = view.local, i = view.toFacets(in), h = normalize(o + i);
    const double unhidden = facets.shadowing(o, i);
    return {facets.visible(o, h) / 4 * unhidden, fresnel(lobe, dot(o, h), view.iorHere)};
}

// Walter et al. 2007, eq. 13 to 21, with the density of visible normals.
Bsdf::Density Bsdf::dielectric(const Lobe& lobe, const View& view, Vec3d in) {
    if (lobe.alpha == 0) return {};
    const Ggx facets(lobe.alpha);
    const Vec3d o = view.local, i = view.toFacets(in);
    if (view.reflects(in)) {
        const Vec3d h = normalize(o + i);
        const double share = refraction(dot(o, h), view.eta).reflectance;
        return {share * facets.visible(o, h) / 4 * facets.shadowing(o, i), Rgb(1.0f)};
    }
    if (!view.transmits(in)) return {};
    const double eta = view.eta;
    const Vec3d sum = o + i * eta;
    const Vec3d h = normalize(sum.z < 0 ? -sum : sum);
    const double cosine = dot(o, h), beyond = -dot(i, h);
    if (!(cosine > 0) || !(beyond > 0)) return {};
    const double share = 1 - refraction(cosine, eta).reflectance;
    return {share * facets.visible(o, h) * cosine * eta * eta * beyond / dot(sum, sum) *
                facets.shadowing(o, i),
            Rgb(static_cast<float>(1 / (eta * eta)))};
}

Bsdf::Density Bsdf::density(const Lobe& lobe, const View& view, Vec3d in) {
    switch (lobe.kind) {
        case Lobe::Kind::Diffuse:
            return diffuse(lobe, view, in);
        case Lobe::Kind::Conductor:
        case Lobe::Kind::Dielectric: {
            if (lobe.alpha == 0) return {};
            const Density once = lobe.kind == Lobe::Kind::Conductor ? conductor(lobe, view, in)
                                                                    : dielectric(lobe, view, in);
            const Density more = again(lobe, view, in);
            const double pdf = once.pdf + more.pdf;
            if (!(pdf > 0)) return {};
            return {pdf, once.ratio * static_cast<float>(once.pdf / pdf) +
                             more.ratio * static_cast<float>(more.pdf / pdf)};
        }
        case Lobe::Kind::Pass:
        case Lobe::Kind::Emissive:
            break;
    }
    return {};
}

Bsdf::Density Bsdf::density(const View& view, Vec3d in) const {
    std::array<Density, 2> parts;
    Density all;
    for (std::size_t i = 0; i < lobes().size(); ++i) {
        parts[i] = density(lobes_[i], view, in);
        all.pdf += lobes_[i].weight / scattering_ * parts[i].pdf;
    }
    if (!(all.pdf > 0)) return {};
    for (std::size_t i = 0; i < lobes().size(); ++i)
        all.ratio += parts[i].ratio * static_cast<float>(lobes_[i].weight * parts[i].pdf / all.pdf);
    return all;
}

BsdfValue Bsdf::scatter(Vec3d out, Vec3d in) const {
    const View view = viewFrom(out);
    if (!(view.cosine > 0)) return {};
    const Density all = density(view, in);
    return {all.ratio * static_cast<float>(all.pdf), all.pdf};
}

const Bsdf::Lobe& Bsdf::choose(double& u) const {
    const double place = u * scattering_;
    const Lobe* chosen = nullptr;
    double before = 0;
    for (const Lobe& lobe : lobes()) {
        if (!lobe.scatters()) continue;
        if (chosen) before += chosen->weight;
        chosen = &lobe;
        if (place < before + lobe.weight) break;
    }
    u = std::clamp((place - before) / chosen->weight, 0.0, 1 - 0x1p-53);
    return *chosen;
}

/// The reflection or refraction at a plane, or at a facet of a rough lobe. A facet may send the ray
/// to other facets.
BsdfSample Bsdf::sampleFacet(const Lobe& lobe, const View& view, std::array<double, 3> u) {
    const Vec3d o = view.local;
    const bool rough = lobe.alpha > 0;
    const Vec3d facet = rough ? Ggx(lobe.alpha).sampleVisible(o, u[1], u[2]) : Vec3d{0, 0, 1};
    const double cosine = dot(o, facet);
    if (!(cosine > 0)) return rough ? sampleAgain(lobe, view, u) : BsdfSample{};
    BsdfSample drawn;
    Vec3d in = mirrored(o, facet);
    if (lobe.kind == Lobe::Kind::Conductor) {
        drawn.weight = fresnel(lobe, cosine, view.iorHere);
    } else {
        const Refraction split = refraction(cosine, view.eta);
        drawn.transmitted = u[0] >= split.reflectance;
        drawn.weight =
            Rgb(drawn.transmitted ? static_cast<float>(1 / (view.eta * view.eta)) : 1.0f);
        if (drawn.transmitted) in = refracted(o, facet, cosine, split.cosine, view.eta);
        u[0] = drawn.transmitted ? (u[0] - split.reflectance) / (1 - split.reflectance)
                                 : u[0] / split.reflectance;
    }
    if (rough) {
        const bool leaves = drawn.transmitted ? in.z < 0 : in.z > 0;
        if (!leaves || u[0] >= Ggx(lobe.alpha).shadowing(o, in)) return sampleAgain(lobe, view, u);
    }
    drawn.direction = normalize(view.fromFacets(in));
    const bool leaks =
        drawn.transmitted ? !view.transmits(drawn.direction) : !view.reflects(drawn.direction);
    return leaks ? BsdfSample{} : drawn;
}

BsdfSample Bsdf::sampleAgain(const Lobe& lobe, const View& view, std::array<double, 3> u) {
    // Further random numbers, made from those that were given.
    RandomStream random(hashOf(std::bit_cast<std::uint64_t>(u[0]),
                               std::bit_cast<std::uint64_t>(u[1]),
                               std::bit_cast<std::uint64_t>(u[2])));
    const FacetEnergy& energy = *lobe.energy;
    BsdfSample drawn;
    bool outside = true;  // of the losses
    if (lobe.kind == Lobe::Kind::Dielectric) {
        drawn.transmitted =
            random.uniform() >= (view.outside ? energy.backOutside : energy.backInside);
        outside = view.outside != drawn.transmitted;
    }
    const double cosine = (outside ? energy.outside : energy.inside).sampleCosine(random.uniform());
    const double sine = std::sqrt((1 - cosine) * (1 + cosine)), phi = 2 * pi * random.uniform();
    drawn.direction = normalize(view.fromFacets(
        {sine * std::cos(phi), sine * std::sin(phi), drawn.transmitted ? -cosine : cosine}));
    drawn.weight = Rgb(1.0f);
    const bool leaks =
        drawn.transmitted ? !view.transmits(drawn.direction) : !view.reflects(drawn.direction);
    return leaks ? BsdfSample{} : drawn;
}

BsdfSample Bsdf::sample(Vec3d out, std::array<double, 3> u) const {
    const View view = viewFrom(out);
    if (!(view.cosine > 0) || !(scattering_ > 0)) return {};
    const Lobe& lobe =
        choose(u[0]);  // the rest of u[0] decides between reflection and transmission
    BsdfSample drawn;
    switch (lobe.kind) {
        case Lobe::Kind::Pass:
            drawn.direction = -out;
            drawn.weight = Rgb(1.0f);
            drawn.transmitted = true;
            break;
        case Lobe::Kind::Diffuse:
            drawn.direction = aroundNormal(view.shading, u[1], u[2]);
            if (!(dot(drawn.direction, view.normal) > 0)) return {};
            break;
        case Lobe::Kind::Conductor:
        case Lobe::Kind::Dielectric:
            drawn = sampleFacet(lobe, view, u);
            if (!(drawn.weight.maximum() > 0)) return {};
            break;
        case Lobe::Kind::Emissive:
            break;
    }
    if (lobe.delta()) {
        drawn.delta = true;
        drawn.weight *= static_cast<float>(scattering_);
        return drawn;
    }
    const Density all = density(view, drawn.direction);
    if (!(all.pdf > 0)) return {};
    drawn.pdf = all.pdf;
    drawn.weight = all.ratio;
    return drawn;
}

Rgb Bsdf::emitted(Vec3d out) const {
    Rgb sum;
    for (const Lobe& lobe : lobes())
        if (lobe.kind == Lobe::Kind::Emissive && (lobe.bothSides || dot(out, point_.normal) > 0))
            sum += lobe.colour * static_cast<float>(lobe.weight);
    return sum;
}

Rgb Bsdf::straightTransmittance(Vec3d direction) const {
    const double low = std::min(point_.iorOutside, point_.iorInside),
                 high = std::max(point_.iorOutside, point_.iorInside);
    const double cosine = std::min(1.0, std::abs(dot(direction, point_.shadingNormal)));
    double share = 0;
    for (const Lobe& lobe : lobes()) {
        if (lobe.kind == Lobe::Kind::Pass) share += lobe.weight;
        if (lobe.kind == Lobe::Kind::Dielectric && cosine > 0)
            share += lobe.weight * (1 - refraction(cosine, high / low).reflectance);
    }
    return Rgb(static_cast<float>(share));
}

Rgb Bsdf::albedo() const {
    Rgb sum;
    for (const Lobe& lobe : lobes()) {
        const auto weight = static_cast<float>(lobe.weight);
        switch (lobe.kind) {
            case Lobe::Kind::Diffuse:
                sum += lobe.colour * weight;
                break;
            case Lobe::Kind::Conductor:
                sum += fresnel(lobe, 1, point_.iorOutside) * weight;
                break;
            case Lobe::Kind::Dielectric:
            case Lobe::Kind::Pass:
                sum += Rgb(weight);
                break;
            case Lobe::Kind::Emissive:
                break;
        }
    }
    return sum;
}

}  // namespace woodcock::surface
