// SPDX-License-Identifier: Apache-2.0
// Renders a ball of fog from memory through the installed package: consumer PICTURE
#include <woodcock/woodcock.h>

#include <cstdio>
#include <vector>

int main(int count, char** words) {
    if (count != 2) return 2;
    constexpr int n = 32;
    std::vector<float> density;
    for (int z = 0; z < n; ++z)
        for (int y = 0; y < n; ++y)
            for (int x = 0; x < n; ++x) {
                const auto square = [](int i) { return (i - 15.5) * (i - 15.5); };
                density.push_back(square(x) + square(y) + square(z) < 200 ? 1.0f : 0.0f);
            }
    try {
        woodcock::Renderer renderer;
        renderer.addVolume({.size = {n, n, n}, .density = density, .voxelSize = 0.1, .scale = 2});
        renderer.setResolution(64, 48);
        renderer.setSamples(4);
        const woodcock::RenderedImage image = renderer.render();
        image.write(words[1]);
        const auto pixels = image.pixels();
        const auto middle = pixels.subspan((24 * 64 + 32) * 4, 4);  // red, green, blue, alpha
        std::printf("woodcock %s: %.3f %.3f %.3f, alpha %.3f\n",
                    woodcock::Renderer::libraryVersion().c_str(), double(middle[0]),
                    double(middle[1]), double(middle[2]), double(middle[3]));
        return 0;
    } catch (const woodcock::Error& error) {
        std::fprintf(stderr, "%s\n", error.what());
        return 1;
    }
}
