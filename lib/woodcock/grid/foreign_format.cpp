// SPDX-License-Identifier: Apache-2.0
#include "woodcock/grid/foreign_format.h"

#include <algorithm>
#include <cctype>
#include <string_view>
#include <vector>

#include "woodcock/grid/vdb/file_bytes.h"

namespace woodcock::grid {

namespace {

using namespace std::string_view_literals;

constexpr std::size_t anywhere = ~std::size_t{0};

/// Bytes at a place of the file.
struct Mark {
    std::string_view bytes;
    std::size_t at = 0;
};

struct Row {
    std::string_view what, way;
    std::vector<Mark> marks;
    std::vector<std::string_view> endings;
    bool readByConvert = false;
};

constexpr std::string_view slicer =
    "load it into 3D Slicer and save it as .nrrd, or use SimpleITK: "
    "sitk.WriteImage(sitk.ReadImage('in'), 'out.nrrd'); then `woodcock convert`";
constexpr std::string_view paraview =
    "use PyVista: numpy.save('out.npy', m['NAME'].reshape(m.dimensions, order='F')) with m = "
    "pyvista.read('in'); then `woodcock convert`";
constexpr std::string_view pointTools =
    "run `pdal translate IN out.csv`, or save it as .ply or .xyz in CloudCompare; then `woodcock "
    "convert`";
constexpr std::string_view blender =
    "import it into Blender and export .obj or .glb; then `woodcock convert`";
constexpr std::string_view hdf5 =
    "use h5py: numpy.save('out.npy', h5py.File('in')['NAME'][...]); then `woodcock convert`";
constexpr std::string_view convertIt = "make a volume of it by `woodcock convert IN out.vdb`";

/// Where several rows fit, the first one counts.
const std::vector<Row>& rows() {
    static const std::vector<Row> all{
        {"a DICOM file",
         "load the whole series into 3D Slicer and save it as .nrrd, or run `dcm2niix -e y "
         "FOLDER`; then `woodcock convert`",
         {{"DICM"sv, 128}, {"\x02\0\0\0UL"sv}, {"\x08\0\x05\0CS"sv}},
         {".dcm", ".dicom", ".ima"}},
        {"a NIfTI image",
         slicer,
         {{"n+1\0"sv, 344}, {"ni1\0"sv, 344}, {"n+2\0\r\n\x1a\n"sv, 4}, {"ni2\0\r\n\x1a\n"sv, 4}},
         {".nii", ".nii.gz"}},
        {"a Radiance picture",
         "name it as the environment of a scene",
         {{"#?RADIANCE"sv}, {"#?RGBE"sv}},
         {}},
        {"an Analyze or NIfTI image", slicer, {}, {".img"}},
        {"a MetaImage", slicer, {{"ObjectType = Image"sv}, {"NDims = 3"sv}}, {".mha", ".mhd"}},
        {"a MINC, NetCDF or MRC file",
         "use Python (netCDF4, nibabel or mrcfile) and numpy.save('out.npy', ...); then "
         "`woodcock convert`",
         {{"CDF\x01"sv}, {"CDF\x02"sv}, {"CDF\x05"sv}},
         {".mnc", ".nc", ".mrc", ".ccp4"}},
        {"a VTK file",
         paraview,
         {{"# vtk DataFile"sv}, {"<VTKFile"sv, anywhere}},
         {".vti", ".vtk", ".vtu", ".vtp", ".vtr", ".vts", ".vtm", ".pvti", ".pvd"}},
        {"a Field3D file",
         "write the cache as .vdb in the program that made it, as Houdini's Geometry ROP does",
         {},
         {".f3d"}},
        {"a MATLAB file",
         "use Python: numpy.save('out.npy', scipy.io.loadmat('in')['NAME']), or h5py for version "
         "7.3; then `woodcock convert`",
         {{"MATLAB 5.0"sv}, {"MATLAB 7.3"sv}},
         {".mat"}},
        {"a LAS or LAZ point cloud", pointTools, {{"LASF"sv}}, {".las", ".laz"}},
        {"an E57 point cloud",
         "save it as .ply or .xyz in CloudCompare; then `woodcock convert`",
         {{"ASTM-E57"sv}},
         {".e57"}},
        {"a PCD point cloud",
         pointTools,
         {{"# .PCD"sv}, {"VERSION .7\nFIELDS"sv}, {"VERSION 0.7\nFIELDS"sv}},
         {".pcd"}},
        {"a point cloud of a scanner's own format",
         "save it as .ply or .xyz in CloudCompare; then `woodcock convert`",
         {},
         {".ptx", ".pts", ".rcp", ".rcs", ".fls", ".zfs"}},
        {"an FBX scene", blender, {{"Kaydara FBX Binary"sv}, {"; FBX"sv}}, {".fbx"}},
        {"an Alembic scene", blender, {{"Ogawa"sv}}, {".abc"}},
        {"a USD file",
         "name the .vdb file that it refers to; of meshes, import them into Blender and export "
         ".obj or .glb for `woodcock convert`",
         {{"PXR-USDC"sv}, {"#usda"sv}},
         {".usd", ".usda", ".usdc", ".usdz"}},
        {"a Blender scene",
         "bake the smoke or export the volume as .vdb, or the mesh as .obj or .glb, in Blender",
         {{"BLENDER"sv}},
         {".blend"}},
        {"a 3D scene of another program",
         blender,
         {},
         {".dae", ".3ds", ".3mf", ".x3d", ".wrl", ".ma", ".mb", ".max", ".c4d", ".lwo", ".off"}},
        {"a Houdini geometry file",
         "save it as .vdb (volumes), .obj or .ply by Houdini's File SOP",
         {{"\x7fNSJb"sv}, {"Bgeo"sv}},
         {".bgeo", ".bgeo.sc", ".geo", ".bgeo.gz"}},
        {"a cache of particles",
         "save them as .csv or .ply in the program that made them; then `woodcock convert`",
         {},
         {".prt"}},
        // Other formats are made of HDF5 too; they come before it.
        {"an HDF5 file", hdf5, {{"\x89HDF\r\n\x1a\n"sv}}, {".h5", ".hdf5", ".hdf", ".he5"}},
        {"a Git LFS pointer",
         "fetch the file itself with `git lfs pull`",
         {{"version https://"sv}},
         {}},
        {"a NanoVDB file", convertIt, {{"NanoVDB"sv}}, {".nvdb"}, true},
        {"a NumPy array", convertIt, {{"\x93NUMPY"sv}}, {".npy"}, true},
        {"an NRRD file", convertIt, {{"NRRD000"sv}}, {".nrrd", ".nhdr"}, true},
        {"a Mitsuba volume", convertIt, {{"VOL\x03"sv}}, {".vol"}, true},
        {"a PLY file", convertIt, {{"ply\n"sv}, {"ply\r\n"sv}}, {".ply"}, true},
        {"a mesh", convertIt, {{"glTF"sv}}, {".obj", ".stl", ".gltf", ".glb"}, true},
        {"a table of points", convertIt, {}, {".csv", ".xyz"}, true},
        {"a file of numbers without a header", convertIt, {}, {".raw"}, true},
        {"a pbrt scene", convertIt, {}, {".pbrt"}, true},
        {"an OpenEXR image",
         "of slices, name all of them to `woodcock convert`: slice.####.exr",
         {{"\x76\x2f\x31\x01"sv}},
         {".exr"},
         true},
        {"a PNG image",
         "of slices, name all of them to `woodcock convert`: slice.####.png",
         {{"\x89PNG"sv}},
         {".png"},
         true},
        {"a TIFF image",
         "of slices, name all of them to `woodcock convert`: slice.####.tif",
         {{"II*\0"sv}, {"MM\0*"sv}},
         {".tif", ".tiff"},
         true},
        {"a gzip archive", "unpack it by `gunzip`", {{"\x1f\x8b\x08"sv}}, {".gz"}},
        {"a zip archive", "unpack it by `unzip`", {{"PK\x03\x04"sv}}, {".zip"}},
    };
    return all;
}

bool isMarked(std::string_view bytes, const Mark& mark) {
    if (mark.at == anywhere) return bytes.find(mark.bytes) != bytes.npos;
    return bytes.size() >= mark.at && bytes.substr(mark.at).starts_with(mark.bytes);
}

bool ends(std::string_view name, std::string_view ending) {
    return name.size() > ending.size() && name.ends_with(ending);
}

bool isArchive(const Row& row) {
    return row.what == "a gzip archive" || row.what == "a zip archive";
}

ForeignFormat found(const Row& row, bool byContent) {
    return {std::string(row.what), std::string(row.way), row.readByConvert, byContent,
            isArchive(row)};
}

/// Archives and containers may hold many formats: where the name tells one, it counts.
bool isContainer(const Row& row) { return row.what == "an HDF5 file" || isArchive(row); }

}  // namespace

std::optional<ForeignFormat> foreignFormat(std::span<const char> beginning,
                                           const std::filesystem::path& path) {
    const std::string_view bytes(beginning.data(), beginning.size());
    std::string name = path.filename().string();
    for (char& c : name) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    const Row* byContent = nullptr;
    const Row* byName = nullptr;
    for (const Row& row : rows()) {
        const auto marked = [&](const Mark& mark) { return isMarked(bytes, mark); };
        const auto ending = [&](std::string_view e) { return ends(name, e); };
        if (!byContent && std::any_of(row.marks.begin(), row.marks.end(), marked)) byContent = &row;
        if (!byName && std::any_of(row.endings.begin(), row.endings.end(), ending)) byName = &row;
    }
    if (byContent && isContainer(*byContent) && byName && !byName->readByConvert)
        return found(*byName, true);
    if (byContent) return found(*byContent, true);
    if (byName) return found(*byName, false);
    return {};
}

std::optional<ForeignFormat> foreignFormat(const std::filesystem::path& path) {
    std::error_code ignored;
    if (!std::filesystem::is_regular_file(path, ignored)) return foreignFormat({}, path);
    try {
        FileBytes file(path);
        file.enter(0, file.size(), "its beginning");
        return foreignFormat(file.bytes(std::min<std::uint64_t>(file.size(), foreignBytes)), path);
    } catch (const Error&) {  // its reader will say why it cannot be read
        return foreignFormat({}, path);
    }
}

}  // namespace woodcock::grid
