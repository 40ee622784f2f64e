// SPDX-License-Identifier: Apache-2.0
#include "woodcock/base/temp_dir.h"

#include <stdlib.h>

#include <cerrno>
#include <fstream>
#include <iterator>
#include <system_error>

#include "woodcock/base/error.h"

namespace woodcock {

TempDir::TempDir() {
    std::string name = (std::filesystem::temp_directory_path() / "woodcock-XXXXXX").string();
    if (!mkdtemp(name.data()))
        throw failure("cannot make the directory '{}': {}", name,
                      std::generic_category().message(errno));
    path_ = name;
}

TempDir::~TempDir() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
}

std::string readText(const std::filesystem::path& file) {
    std::ifstream in(file, std::ios::binary);
    if (!in) throw failure("cannot read '{}'", file.string());
    return {std::istreambuf_iterator<char>(in), {}};
}

void writeText(const std::filesystem::path& file, const std::string& text) {
    std::ofstream out(file, std::ios::binary);
    if (!out.write(text.data(), static_cast<std::streamsize>(text.size())).flush())
        throw failure("cannot write '{}'", file.string());
}

}  // namespace woodcock
