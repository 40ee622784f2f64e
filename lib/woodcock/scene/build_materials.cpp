// SPDX-License-Identifier: Apache-2.0
#include "woodcock/scene/build_materials.h"

#include <algorithm>
#include <cmath>

#include "woodcock/scene/check_surfaces.h"
#include "woodcock/scene/load_surfaces.h"

namespace woodcock::scene {
namespace {

using Image = std::shared_ptr<const surface::TextureImage>;

surface::Material buildMaterial(const DiffuseDescription& m, const Image& image,
                                const SceneDescription&) {
    return surface::DiffuseMaterial{makeTexture(m.colour, image)};
}
surface::Material buildMaterial(const ConductorDescription& m, const Image& image,
                                const SceneDescription&) {
    surface::ConductorMaterial conductor;
    conductor.fresnelColour = makeTexture(m.colour, image);
    conductor.roughness = m.roughness;
    conductor.schlick = !m.etaK;
    if (m.etaK) std::tie(conductor.eta, conductor.k) = *m.etaK;
    return conductor;
}
surface::Material buildMaterial(const DielectricDescription& m, const Image&,
                                const SceneDescription&) {
    return surface::DielectricMaterial{m.ior, m.roughness};
}
surface::Material buildMaterial(const InterfaceDescription&, const Image&,
                                const SceneDescription&) {
    return surface::InterfaceMaterial();
}
surface::Material buildMaterial(const EmissiveDescription& m, const Image& image,
                                const SceneDescription&) {
    return surface::EmissiveMaterial{surface::Texture(m.radiance.colour, image), m.bothSides};
}
surface::Material buildMaterial(const MixDescription& m, const Image& image,
                                const SceneDescription& scene) {
    return surface::MixMaterial{materialIndex(scene, m.first), materialIndex(scene, m.second),
                                makeTexture(m.weight, image)};
}

/// The longer side of the largest image that decides about emission; 0: there is none.
int finestTexture(const std::vector<surface::Material>& materials, std::uint32_t index) {
    const auto side = [](const surface::Texture& texture) {
        return texture.image ? std::max(texture.image->width(), texture.image->height()) : 0;
    };
    if (const auto* emissive = std::get_if<surface::EmissiveMaterial>(&materials[index]))
        return side(emissive->radiance);
    if (const auto* mix = std::get_if<surface::MixMaterial>(&materials[index]))
        return std::max({side(mix->weight), finestTexture(materials, mix->first),
                         finestTexture(materials, mix->second)});
    return 0;
}

/// How often to cut the sides of a triangle, so that the pieces are about two texels wide.
int cutsOf(const std::array<mesh::Vec2f, 3>& uv, int texels) {
    constexpr int most = 64;
    float longest = 0;
    for (size_t i = 0; i < 3; ++i) {
        const mesh::Vec2f a = uv[i], b = uv[(i + 1) % 3];
        longest = std::max({longest, std::abs(a.u - b.u), std::abs(a.v - b.v)});
    }
    const double pieces = std::ceil(double{longest} * texels / 2);
    return pieces < most ? std::max(1, static_cast<int>(pieces)) : most;
}

/// Mean over a triangle, from the centres of the equal pieces that `cuts` leave of it.
Emission meanOver(const std::vector<surface::Material>& materials, std::uint32_t index,
                  const std::array<mesh::Vec2f, 3>& uv, int cuts) {
    Vec3d sum;
    Emission mean;
    const auto add = [&](double b1, double b2) {
        const double b0 = 1 - b1 - b2;
        mean = emissionAt(materials, index, b0 * uv[0].u + b1 * uv[1].u + b2 * uv[2].u,
                          b0 * uv[0].v + b1 * uv[1].v + b2 * uv[2].v, true);
        sum += Vec3d{mean.radiance[0], mean.radiance[1], mean.radiance[2]};
    };
    for (int i = 0; i < cuts; ++i)
        for (int j = 0; i + j < cuts; ++j) {
            add((i + 1.0 / 3) / cuts, (j + 1.0 / 3) / cuts);
            if (i + j + 1 < cuts) add((i + 2.0 / 3) / cuts, (j + 2.0 / 3) / cuts);
        }
    sum = sum / (double(cuts) * cuts);
    mean.radiance = Rgb::map([&](int c) { return static_cast<float>(sum[c]); });
    return mean;
}

}  // namespace

std::uint32_t materialIndex(const SceneDescription& description, std::string_view name) {
    return static_cast<std::uint32_t>(
        findNamed(description.materials, name).value_or(description.materials.size()));
}

std::vector<surface::Material> buildMaterials(const SceneDescription& description,
                                              const LoadedScene& loaded) {
    std::vector<surface::Material> materials;
    for (size_t i = 0; i < description.materials.size(); ++i)
        materials.push_back(std::visit(
            [&](const auto& m) { return buildMaterial(m, loaded.textures[i], description); },
            description.materials[i].material));
    materials.emplace_back(surface::DiffuseMaterial());
    return materials;
}

Emission emissionAt(const std::vector<surface::Material>& materials, std::uint32_t index, double u,
                    double v, bool front) {
    if (const auto* emissive = std::get_if<surface::EmissiveMaterial>(&materials[index])) {
        const bool dark = !front && !emissive->bothSides;
        return {dark ? Rgb(0.0f) : emissive->radiance.at(u, v), emissive->bothSides};
    }
    const auto* mix = std::get_if<surface::MixMaterial>(&materials[index]);
    if (!mix) return {};
    const float weight = mix->weight.at(u, v).mean();
    const Emission first = emissionAt(materials, mix->first, u, v, front),
                   second = emissionAt(materials, mix->second, u, v, front);
    return {first.radiance * (1 - weight) + second.radiance * weight,
            first.bothSides || second.bothSides};
}

bool emissionVaries(const std::vector<surface::Material>& materials, std::uint32_t index) {
    return std::holds_alternative<surface::MixMaterial>(materials[index]) ||
           finestTexture(materials, index) > 0;
}

std::vector<Emission> meanEmission(const std::vector<surface::Material>& materials,
                                   std::uint32_t material, const mesh::SurfaceMesh& mesh) {
    const int texels = mesh.uvs.empty() ? 0 : finestTexture(materials, material);
    std::vector<Emission> emission;
    bool dark = true;
    for (size_t i = 0; i < mesh.mesh.triangles.size(); ++i) {
        const auto uv = mesh.uvs.empty() ? std::array<mesh::Vec2f, 3>{} : mesh.uvs[i];
        emission.push_back(meanOver(materials, material, uv, cutsOf(uv, texels)));
        dark &= !(emission.back().radiance.maximum() > 0);
    }
    if (dark) emission.clear();
    return emission;
}

}  // namespace woodcock::scene
