// SPDX-License-Identifier: Apache-2.0
#include "tools/common/about.h"

#include <fmt/format.h>

#include <string_view>
#include <thread>
#include <vector>

#include "build_commit.h"
#include "build_facts.h"
#include "woodcock/base/version.h"
#include "woodcock/image/image_format.h"

namespace woodcock::tool {

namespace {

/// Instruction sets that matter to renders, of the compiled code.
std::string compiledFeatures() {
    std::vector<std::string_view> features;
#ifdef __SSE2__
    features.push_back("SSE2");
#endif
#ifdef __SSE4_2__
    features.push_back("SSE4.2");
#endif
#ifdef __AVX__
    features.push_back("AVX");
#endif
#ifdef __AVX2__
    features.push_back("AVX2");
#endif
#ifdef __FMA__
    features.push_back("FMA");
#endif
#ifdef __AVX512F__
    features.push_back("AVX-512");
#endif
#ifdef __ARM_NEON
    features.push_back("NEON");
#endif
    return features.empty() ? "none known" : fmt::format("{}", fmt::join(features, " "));
}

/// The same of the processor that it runs on.
std::string machineFeatures() {
    std::vector<std::string_view> features;
#if defined(__x86_64__) || defined(__i386__)
    __builtin_cpu_init();
    if (__builtin_cpu_supports("sse2")) features.push_back("SSE2");
    if (__builtin_cpu_supports("sse4.2")) features.push_back("SSE4.2");
    if (__builtin_cpu_supports("avx")) features.push_back("AVX");
    if (__builtin_cpu_supports("avx2")) features.push_back("AVX2");
    if (__builtin_cpu_supports("fma")) features.push_back("FMA");
    if (__builtin_cpu_supports("avx512f")) features.push_back("AVX-512");
#elif defined(__ARM_NEON)
    features.push_back("NEON");
#endif
    return features.empty() ? "none known" : fmt::format("{}", fmt::join(features, " "));
}

}  // namespace

std::string programVersion() {
    constexpr std::string_view commit = WOODCOCK_COMMIT;
    return fmt::format("woodcock {}{}", version(),
                       commit.empty() ? "" : fmt::format(" ({})", commit));
}

std::string aboutProgram() {
    constexpr std::string_view commit = WOODCOCK_COMMIT;
    return fmt::format(
        "woodcock {}\n"
        "commit:       {}\n"
        "build:        {} {}, uses {}\n"
        "this machine: {} threads, has {}\n"
        "libraries:    {}, {}",
        version(), commit.empty() ? "unknown, as it was not built in a Git repository" : commit,
        WOODCOCK_COMPILER, WOODCOCK_BUILD_TYPE, compiledFeatures(),
        std::thread::hardware_concurrency(), machineFeatures(), WOODCOCK_LIBRARIES,
        image::imageLibraries());
}

}  // namespace woodcock::tool
