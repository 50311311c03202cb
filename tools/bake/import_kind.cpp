// In: a file's bytes. Out: which of the kinds that people take for models it is.
#include "tools/bake/import_kind.hpp"

#include <algorithm>
#include <cstring>

#include "tools/bake/import_text.hpp"

namespace espalier::import {
namespace {

constexpr const char *kExport = "export the model as glTF 2.0 (.glb)", *kUnpack = "unpack it first",
                     *kNoModel = "it holds no model";

// Kinds that are told by their first bytes, or by the bytes at `at`.
struct Magic {
    std::string_view bytes;
    FileKind kind;
    size_t at = 0;
};
using namespace std::string_view_literals;
const Magic kMagics[] = {
    {"Kaydara FBX Binary"sv, {"FBX", Reader::assimp, ".fbx", kExport}},
    {"; FBX "sv, {"FBX (text)", Reader::assimp, ".fbx", kExport}},
    {"xof 0"sv, {"a DirectX model (.x)", Reader::assimp, ".x", kExport}},
    {"OFF\n"sv, {"OFF", Reader::assimp, ".off", kExport}},
    {"OFF\r"sv, {"OFF", Reader::assimp, ".off", kExport}},
    {"LWO2"sv, {"a LightWave object", Reader::assimp, ".lwo", kExport}, 8},
    {"LWOB"sv, {"a LightWave object", Reader::assimp, ".lwo", kExport}, 8},
    {"BLENDER"sv, {"a Blender file", Reader::none, ".blend", kExport}},
    {"PXR-USDC"sv, {"USD (binary)", Reader::none, ".usdc", kExport}},
    {"#usda "sv, {"USD (text)", Reader::none, ".usda", kExport}},
    {"ISO-10303-21;"sv, {"STEP, which describes solids by exact surfaces", Reader::none, ".stp", kExport}},
    {"3D Geometry File Format "sv, {"a Rhinoceros file", Reader::none, ".3dm", kExport}},
    {"//Maya ASCII"sv, {"a Maya file", Reader::none, ".ma", kExport}},
    {"FOR4"sv, {"a Maya file", Reader::none, ".mb", kExport}},
    {"FOR8"sv, {"a Maya file", Reader::none, ".mb", kExport}},
    {"QC4DC4D6"sv, {"a Cinema 4D file", Reader::none, ".c4d", kExport}},
    {"\xFF\xFE\xFF\x0ES\0k\0e\0t\0c\0h\0"sv, {"a SketchUp file", Reader::none, ".skp", kExport}},
    {"\xD0\xCF\x11\xE0\xA1\xB1\x1A\xE1"sv, {"a 3ds Max file or an old office document", Reader::none, ".max", kExport}},
    {"#VRML"sv, {"VRML", Reader::none, ".wrl", kExport}},
    {"glTF\1\0\0\0"sv, {"glTF 1.0", Reader::none, ".glb", "convert the model to glTF 2.0"}},
    {"LASF"sv, {"a LAS point cloud", Reader::none, ".las", "make a mesh of its points first"}},
    {"ASTM-E57"sv, {"an E57 point cloud", Reader::none, ".e57", "make a mesh of its points first"}},
    {"# .PCD"sv, {"a PCD point cloud", Reader::none, ".pcd", "make a mesh of its points first"}},
    {"version https://git-lfs"sv,
     {"a pointer of Git LFS, not the file itself", Reader::none, "", "run 'git lfs pull'"}},
    {"\x28\xB5\x2F\xFD"sv, {"a zstd archive, as Blender packs its files", Reader::none, ".zst", kUnpack}},
    {"7z\xBC\xAF\x27\x1C"sv, {"a 7z archive", Reader::none, ".7z", kUnpack}},
    {"Rar!"sv, {"a RAR archive", Reader::none, ".rar", kUnpack}},
    {"BZh"sv, {"a bzip2 archive", Reader::none, ".bz2", kUnpack}},
    {"\xFD"
     "7zXZ"sv,
     {"an xz archive", Reader::none, ".xz", kUnpack}},
    {"ustar"sv, {"a tar archive", Reader::none, ".tar", kUnpack}, 257},
    {"\x89PNG"sv, {"a PNG picture", Reader::none, ".png", kNoModel}},
    {"\xFF\xD8\xFF"sv, {"a JPEG picture", Reader::none, ".jpg", kNoModel}},
    {"%PDF"sv, {"a PDF document", Reader::none, ".pdf", kNoModel}},
    {"\x7F"
     "ELF"sv,
     {"a program", Reader::none, "", kNoModel}},
    {"\xFF\xFE"sv, {"text in UTF-16", Reader::none, "", "save it as UTF-8"}},
    {"\xFE\xFF"sv, {"text in UTF-16", Reader::none, "", "save it as UTF-8"}},
};

const FileKind kStl{"STL", Reader::stl, ".stl", kExport}, k3ds{"3D Studio (.3ds)", Reader::assimp, ".3ds", kExport},
    kCollada{"COLLADA", Reader::assimp, ".dae", kExport}, kX3d{"X3D", Reader::assimp, ".x3d", kExport},
    kWebPage{"a web page, not the file that it offers", Reader::none, ".html", "download the model itself"},
    kXml{"XML of a kind that holds no model known here", Reader::none, ".xml", kExport},
    kUsdz{"USD (packed)", Reader::none, ".usdz", kExport}, k3mf{"3MF", Reader::assimp, ".3mf", kExport},
    kZip{"a ZIP archive", Reader::none, ".zip", kUnpack}, kEmpty{"empty", Reader::none, "", kNoModel};

std::string_view textOf(Bytes file) {
    return {reinterpret_cast<const char*>(file.data()), file.size()};
}

uint32_t wordAt(Bytes file, size_t at) {
    uint32_t value = 0;
    if (at + 4 <= file.size()) std::memcpy(&value, file.data() + at, 4);
    return value;
}

// Told by what is packed first.
const FileKind* kindOfZip(std::string_view text) {
    const size_t length = text.size() < 30 ? 0 : uint8_t(text[26]) | size_t(uint8_t(text[27])) << 8;
    const std::string_view name = text.size() < 30 ? text.substr(0, 0) : text.substr(30, length);
    if (name.ends_with(".usdc") || name.ends_with(".usda") || name.ends_with(".usd")) return &kUsdz;
    if (name == "[Content_Types].xml" && text.find("3dmodel.model") != text.npos) return &k3mf;
    return name.starts_with("3D/") ? &k3mf : &kZip;
}

const FileKind* kindOfXml(std::string_view text) {
    const auto has = [head = text.substr(0, 4096)](std::string_view word) { return head.find(word) != head.npos; };
    if (has("<COLLADA")) return &kCollada;
    if (has("<X3D")) return &kX3d;
    if (has("<html") || has("<HTML") || has("<!DOCTYPE html") || has("<!doctype html")) return &kWebPage;
    return &kXml;
}

}  // namespace

const FileKind* kindOf(Bytes file) {
    const std::string_view text = textOf(file);
    if (text.empty()) return &kEmpty;
    for (const Magic& magic : kMagics)
        if (text.size() >= magic.at && text.substr(magic.at).starts_with(magic.bytes)) return &magic.kind;
    if (text.starts_with("PK\3\4")) return kindOfZip(text);
    // A chunk 0x4D4D that is as long as the file.
    if (text.starts_with("MM") && wordAt(file, 2) == file.size()) return &k3ds;
    if (file.size() > 84 && wordAt(file, 80) == (file.size() - 84) / 50 && (file.size() - 84) % 50 == 0) return &kStl;
    std::string_view head = withoutByteOrderMark(text).substr(0, 65536);
    head.remove_prefix(std::min(head.find_first_not_of(" \t\r\n"), head.size()));
    if (head.starts_with("<")) return kindOfXml(head);
    if (head.starts_with("solid") && (head.find("facet") != head.npos || head.find("endsolid") != head.npos))
        return &kStl;
    return nullptr;
}

bool looksLikeObj(Bytes file) {
    bool vertices = false, faces = false;
    std::string_view text = withoutByteOrderMark(textOf(file));
    while (!text.empty() && !(vertices && faces)) {
        std::string_view line = nextLine(text), key = nextWord(line);
        double number = 0;
        vertices = vertices || (key == "v" && toNumber(nextWord(line), number));
        faces = faces || (key == "f" && !trimmed(line).empty());
    }
    return vertices && faces;
}

}  // namespace espalier::import
