// SPDX-License-Identifier: Apache-2.0
#include "woodcock/grid/vdb_header.h"

#include <cctype>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <string_view>

#include "woodcock/base/error.h"

namespace woodcock {

namespace {

constexpr std::int64_t magic = 0x56444220;    // "VDB ", as a number
constexpr std::uint32_t oldestVersion = 222;  // OpenVDB 3 writes 222 or 223
constexpr std::string_view halfSuffix = "_HalfFloat";

class Reader {
public:
    explicit Reader(const std::filesystem::path& file)
        : file_(file), in_(file, std::ios::binary), size_(std::filesystem::file_size(file)) {
        if (!in_) throw inputError("cannot open {}: {}", file.string(), std::strerror(errno));
    }

    template <class T>
    T value() {
        T v{};
        bytes(&v, sizeof v);
        return v;
    }
    std::string text() {
        const auto n = value<std::uint32_t>();
        if (n > left()) throw cutShort();
        std::string s(n, '\0');
        bytes(s.data(), n);
        return s;
    }
    void skip(std::uint32_t n) {
        if (n > left()) throw cutShort();
        in_.seekg(n, std::ios::cur);
    }
    void seek(std::int64_t position) { in_.seekg(position); }

    /// The first bytes of the file, as many of sixteen as it has.
    std::string beginning() {
        std::string s(std::min<std::uintmax_t>(size_, 16), '\0');
        seek(0);
        bytes(s.data(), s.size());
        return s;
    }
    std::uintmax_t size() const { return size_; }

    Error cutShort() const {
        return inputError("{} is cut short or damaged: its list of grids does not fit in {} bytes",
                          file_.string(), size_);
    }

private:
    std::uintmax_t left() { return size_ - static_cast<std::uintmax_t>(in_.tellg()); }
    void bytes(void* to, std::size_t n) {
        if (!in_.read(static_cast<char*>(to), static_cast<std::streamsize>(n))) throw cutShort();
    }

    std::filesystem::path file_;
    std::ifstream in_;
    std::uintmax_t size_;
};

/// The unique names of a file mark their number by a control character: "density\x1e1".
std::string readableName(std::string name) {
    if (const auto mark = name.find('\x1e'); mark != std::string::npos) {
        name[mark] = '[';
        name += ']';
    }
    return name;
}

Error notVdb(const std::filesystem::path& file, const std::string& beginning) {
    if (beginning.empty()) return inputError("{} is not a VDB file: it is empty", file.string());
    struct Kind {
        std::string_view start, what;
    };
    constexpr Kind known[]{
        {"NanoVDB", "a NanoVDB file; convert it with `nanovdb_convert in.nvdb out.vdb`"},
        {"\x89HDF", "an HDF5 file, as Field3D and scientific data use"},
        {"\x76\x2f\x31\x01", "an OpenEXR image"},
        {"\x89PNG", "a PNG image"},
        {"PK\x03\x04", "a zip archive"},
        {"\x1f\x8b", "a gzip archive"},
        {"PXR-USDC", "a USD file; name the .vdb file that it refers to"},
        {"#usda", "a USD file; name the .vdb file that it refers to"},
        {"version https://", "a Git LFS pointer; fetch the file itself with `git lfs pull`"},
    };
    for (const Kind& kind : known)
        if (beginning.starts_with(kind.start))
            return inputError("{} is not a VDB file but {}", file.string(), kind.what);
    std::string shown;
    for (char c : beginning) {
        const auto u = static_cast<unsigned char>(c);
        shown += std::isprint(u) ? std::string(1, c) : fmt::format("\\x{:02x}", u);
    }
    return inputError("{} is not a VDB file: it begins with \"{}\"", file.string(), shown);
}

VdbHeader::Entry readEntry(Reader& in) {
    VdbHeader::Entry entry;
    entry.uniqueName = readableName(in.text());
    entry.treeType = in.text();
    if (entry.treeType.ends_with(halfSuffix)) {
        entry.savedAsHalf = true;
        entry.treeType.resize(entry.treeType.size() - halfSuffix.size());
    }
    in.text();  // the grid that this one shares its tree with
    entry.begin = in.value<std::int64_t>();
    in.value<std::int64_t>();  // where its voxels begin
    entry.end = in.value<std::int64_t>();
    return entry;
}

}  // namespace

VdbHeader readVdbHeader(const std::filesystem::path& file) {
    std::error_code error;
    const auto status = std::filesystem::status(file, error);
    if (!exists(status)) throw inputError("{} does not exist", file.string());
    if (is_directory(status))
        throw inputError("{} is a directory; expected a .vdb file", file.string());
    if (!is_regular_file(status))
        throw inputError("{} is not a regular file; expected a .vdb file", file.string());

    Reader in(file);
    if (in.size() < sizeof magic || in.value<std::int64_t>() != magic)
        throw notVdb(file, in.beginning());
    VdbHeader header;
    header.fileVersion = in.value<std::uint32_t>();
    if (header.fileVersion < oldestVersion)
        throw inputError(
            "{} has VDB file format {}, older than the {} of OpenVDB 3; save it again "
            "with a newer program",
            file.string(), header.fileVersion, oldestVersion);
    header.libraryMajor = in.value<std::uint32_t>();
    header.libraryMinor = in.value<std::uint32_t>();
    header.hasOffsets = in.value<char>() != 0;
    if (!header.hasOffsets) return header;

    in.skip(36);  // the file's UUID
    for (auto n = in.value<std::uint32_t>(); n > 0;
         --n) {  // metadata of the file: name, type, value
        in.text();
        in.text();
        in.skip(in.value<std::uint32_t>());
    }
    for (auto n = in.value<std::uint32_t>(); n > 0; --n) {
        VdbHeader::Entry entry = readEntry(in);
        if (entry.begin < 0 || entry.end < entry.begin) throw in.cutShort();
        if (static_cast<std::uintmax_t>(entry.end) > in.size())
            throw inputError("{} is cut short: grid '{}' ends at byte {}, the file at byte {}",
                             file.string(), entry.uniqueName, entry.end, in.size());
        in.seek(entry.end);
        header.entries.push_back(std::move(entry));
    }
    return header;
}

}  // namespace woodcock
