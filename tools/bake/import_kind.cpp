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
    {"Kaydara FBX Binary"sv, {"FBX", ReadBy::assimp, ".fbx", kExport}},
    {"; FBX "sv, {"FBX (text)", ReadBy::assimp, ".fbx", kExport}},
    {"FBXHeaderExtension"sv, {"FBX (text)", ReadBy::assimp, ".fbx", kExport}},
    {"xof 0"sv, {"a DirectX model (.x)", ReadBy::assimp, ".x", kExport}},
    {"OFF\n"sv, {"OFF", ReadBy::assimp, ".off", kExport}},
    {"OFF\r"sv, {"OFF", ReadBy::assimp, ".off", kExport}},
    {"LWO2"sv, {"a LightWave object", ReadBy::assimp, ".lwo", kExport}, 8},
    {"LWOB"sv, {"a LightWave object", ReadBy::assimp, ".lwo", kExport}, 8},
    {"BLENDER"sv, {"a Blender file", ReadBy::none, ".blend", kExport}},
    {"PXR-USDC"sv, {"USD (binary)", ReadBy::none, ".usdc", kExport}},
    {"#usda "sv, {"USD (text)", ReadBy::none, ".usda", kExport}},
    {"ISO-10303-21;"sv, {"STEP, which describes solids by exact surfaces", ReadBy::none, ".stp", kExport}},
    {"3D Geometry File Format "sv, {"a Rhinoceros file", ReadBy::none, ".3dm", kExport}},
    {"//Maya ASCII"sv, {"a Maya file", ReadBy::none, ".ma", kExport}},
    {"FOR4"sv, {"a Maya file", ReadBy::none, ".mb", kExport}},
    {"FOR8"sv, {"a Maya file", ReadBy::none, ".mb", kExport}},
    {"QC4DC4D6"sv, {"a Cinema 4D file", ReadBy::none, ".c4d", kExport}},
    {"\xFF\xFE\xFF\x0ES\0k\0e\0t\0c\0h\0"sv, {"a SketchUp file", ReadBy::none, ".skp", kExport}},
    {"\xD0\xCF\x11\xE0\xA1\xB1\x1A\xE1"sv, {"a 3ds Max file or an old office document", ReadBy::none, ".max", kExport}},
    {"#VRML"sv, {"VRML", ReadBy::none, ".wrl", kExport}},
    {"glTF\1\0\0\0"sv, {"glTF 1.0", ReadBy::none, ".glb", "convert the model to glTF 2.0"}},
    {"LASF"sv, {"a LAS point cloud", ReadBy::none, ".las", "make a mesh of its points first"}},
    {"ASTM-E57"sv, {"an E57 point cloud", ReadBy::none, ".e57", "make a mesh of its points first"}},
    {"# .PCD"sv, {"a PCD point cloud", ReadBy::none, ".pcd", "make a mesh of its points first"}},
    {"version https://git-lfs"sv,
     {"a pointer of Git LFS, not the file itself", ReadBy::none, "", "run 'git lfs pull'"}},
    {"\x28\xB5\x2F\xFD"sv, {"a zstd archive, as Blender packs its files", ReadBy::none, ".zst", kUnpack}},
    {"7z\xBC\xAF\x27\x1C"sv, {"a 7z archive", ReadBy::none, ".7z", kUnpack}},
    {"Rar!"sv, {"a RAR archive", ReadBy::none, ".rar", kUnpack}},
    {"BZh"sv, {"a bzip2 archive", ReadBy::none, ".bz2", kUnpack}},
    {"\xFD"
     "7zXZ"sv,
     {"an xz archive", ReadBy::none, ".xz", kUnpack}},
    {"ustar"sv, {"a tar archive", ReadBy::none, ".tar", kUnpack}, 257},
    {"\x89PNG"sv, {"a PNG picture", ReadBy::none, ".png", kNoModel}},
    {"\xFF\xD8\xFF"sv, {"a JPEG picture", ReadBy::none, ".jpg", kNoModel}},
    {"%PDF"sv, {"a PDF document", ReadBy::none, ".pdf", kNoModel}},
    {"\x7F"
     "ELF"sv,
     {"a program", ReadBy::none, "", kNoModel}},
    {"\xFF\xFE"sv, {"text in UTF-16", ReadBy::none, "", "save it as UTF-8"}},
    {"\xFE\xFF"sv, {"text in UTF-16", ReadBy::none, "", "save it as UTF-8"}},
};

const FileKind kStl{"STL", ReadBy::stl, ".stl", kExport}, k3ds{"3D Studio (.3ds)", ReadBy::assimp, ".3ds", kExport},
    kCollada{"COLLADA", ReadBy::assimp, ".dae", kExport}, kX3d{"X3D", ReadBy::assimp, ".x3d", kExport},
    kWebPage{"a web page, not the file that it offers", ReadBy::none, ".html", "download the model itself"},
    kXml{"XML of a kind that holds no model known here", ReadBy::none, ".xml", kExport},
    kUsdz{"USD (packed)", ReadBy::none, ".usdz", kExport}, k3mf{"3MF", ReadBy::assimp, ".3mf", kExport},
    kZip{"a ZIP archive", ReadBy::none, ".zip", kUnpack}, kEmpty{"empty", ReadBy::none, "", kNoModel};

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
    const std::string small = smallLetters(head);
    const bool stl =
        small.starts_with("solid") && (small.find("facet") != small.npos || small.find("endsolid") != small.npos);
    return stl ? &kStl : nullptr;
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
