// SPDX-License-Identifier: Apache-2.0
// What `woodcock render` does with a VDB file, for many files in one process, at 4x4 pixels.
// usage: render_each SECONDS FILE...
// For each file a line: "rendered", or "error: " and why. A file that takes more than SECONDS of
// processor time, or waits for long, ends the program by a signal; anything but an error of bad
// input ends it with 1.
#include <sys/time.h>
#include <unistd.h>

#include <cstdio>
#include <cstdlib>
#include <string>

#include "woodcock/base/error.h"
#include "woodcock/render/session.h"
#include "woodcock/scene/build.h"
#include "woodcock/scene/defaults.h"
#include "woodcock/scene/load.h"
#include "woodcock/scene/scene_file.h"

namespace {

using namespace woodcock;
using namespace woodcock::scene;

void renderFile(const std::string& file, bool repair) {
    SceneDescription scene =
        parseSceneText(defaultSceneText({file}), "command line", "",
                       {repair ? "volume[0].repair=true" : "volume[0].repair=false"});
    LoadedScene loaded = loadScene(scene);
    completeScene(scene, loaded);
    render::RenderSettings settings;
    settings.width = settings.height = 4;
    settings.endSample = 1;
    render::render(buildScene(scene, std::move(loaded)), settings);
}

/// Repairs values that are refused, as far as that helps.
std::string outcome(const std::string& file) {
    std::string why;
    for (const bool repair : {false, true}) {
        try {
            renderFile(file, repair);
            return "rendered";
        } catch (const Error& e) {
            if (e.kind() != ErrorKind::Input) throw;
            why = e.what();
        }
    }
    return "error: " + why;
}

}  // namespace

int main(int count, char** words) {
    if (count < 2) return 2;
    const int seconds = std::atoi(words[1]);
    try {
        for (int i = 2; i < count; ++i) {
            const itimerval timer{{0, 0}, {seconds, 0}};
            setitimer(ITIMER_PROF, &timer, nullptr);
            alarm(12 * static_cast<unsigned>(seconds));
            std::printf("%s\n", outcome(words[i]).c_str());
            std::fflush(stdout);
        }
        return 0;
    } catch (const std::exception& e) {
        std::fprintf(stderr, "%s\n", e.what());
        return 1;
    }
}
