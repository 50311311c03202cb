// Generates and writes all content. In: options. Out: files; nothing is left half-written.

#include "tools/content/content.hpp"

#include <filesystem>

#include <deque>
#include <glm/gtc/matrix_transform.hpp>

#include "tools/content/forms.hpp"
#include "tools/content/glb.hpp"
#include "tools/content/leaf.hpp"
#include "tools/content/noise.hpp"
#include "tools/content/pieces.hpp"
#include "tools/content/preview.hpp"
#include "tools/content/props.hpp"
#include "tools/content/roof_mesh.hpp"
#include "tools/content/ruin.hpp"
#include "tools/content/site.hpp"

namespace espalier::content {
namespace {

Status makeDirectory(const std::string& path) {
    std::error_code error;
    std::filesystem::create_directories(path, error);
    if (error) return Failure(path, "can't be made: " + error.message());
    return Done{};
}

Status writeRuin(const Options& options) {
    Ruin ruin = makeRuin(options.textureSize);
    Glb glb;
    glb.images.push_back({"ruin color", encodeJpeg(ruin.painted.color, 92), false});
    glb.images.push_back({"ruin normal", encodeJpeg(ruin.painted.normal, 94), false});
    glb.materials.push_back({"masonry", 0, 1, 0.92f, 0, false, false});
    glb.meshes.push_back({"ruin", &ruin.assembly.mesh, 0});
    if (Status s = writeGlb(options.directory + "/ruin.glb", glb); !s) return s;
    if (Status s = writeBytes(options.directory + "/mask.png", encodePng(ruin.painted.mask, 1)); !s) return s;
    if (Status s = writeBytes(options.directory + "/ivy.png", encodePng(ruin.painted.ivy, 1)); !s) return s;
    if (options.previewDirectory.empty()) return Done{};
    struct Shot {
        const char* name;
        PreviewView view;
    };
    std::vector<PreviewItem> items{
        {&ruin.assembly.mesh, &ruin.painted.color, &ruin.painted.normal, false, glm::mat4(1)}};
    PreviewView wide{{4.2f, 2.4f, 8.6f}, {-0.1f, 1.45f, 0.4f}, 38, 1280, 720, {0.55f, 0.75f, 0.55f}, true};
    PreviewView arch{{0.9f, 1.6f, 4.2f}, {0.4f, 1.6f, 0}, 42, 1280, 720, {0.6f, 0.6f, 0.5f}, true};
    PreviewView column{{3.6f, 1.9f, 4.6f}, {2.2f, 1.5f, 1.9f}, 48, 720, 960, {0.6f, 0.6f, 0.5f}, true};
    PreviewView back{{-5.5f, 3.6f, -5.5f}, {-0.5f, 1.3f, 0.3f}, 42, 1280, 720, {-0.5f, 0.7f, -0.6f}, true};
    PreviewView stump{{-0.2f, 1.9f, 4.2f}, {-1.4f, 0.6f, 2.0f}, 42, 1280, 720, {0.6f, 0.6f, 0.5f}, true};
    PreviewView vase{{0.9f, 2.0f, 6.0f}, {-0.75f, 1.25f, 3.55f}, 48, 720, 960, {0.6f, 0.6f, 0.5f}, true};
    PreviewView above{{0.3f, 9.5f, 5.0f}, {0, 0.8f, 0.6f}, 45, 1280, 720, {0.5f, 0.8f, 0.3f}, true};
    for (const Shot& shot : {Shot{"wide", wide}, Shot{"arch", arch}, Shot{"column", column}, Shot{"back", back},
                             Shot{"stump", stump}, Shot{"urn", vase}, Shot{"above", above}})
        if (Status s = writeBytes(options.previewDirectory + "/ruin_" + shot.name + ".png",
                                  encodePng(preview(items, shot.view), 3));
            !s)
            return s;
    if (Status s = writeBytes(options.previewDirectory + "/ruin_color.png", encodePng(ruin.painted.color, 3)); !s)
        return s;
    return writeBytes(options.previewDirectory + "/ruin_normal.png", encodePng(ruin.painted.normal, 3));
}

// A material's pictures.
struct Painted {
    const Picture *color, *normal;
};

Status previewTerminals(const Options& options, const Glb& glb, const std::array<Painted, 4>& painted) {
    std::vector<PreviewItem> items;
    float x = -4.4f;
    for (auto& m : glb.meshes) {
        float y = m.name.find("lod0") != std::string::npos   ? 1.2f
                  : m.name.find("lod1") != std::string::npos ? 0.0f
                                                             : -1.2f;
        if (y > 1) x += 1.15f;
        glm::mat4 place = glm::translate(glm::mat4(1), glm::vec3(x, y, 0));
        if (m.material == 1)
            place = glm::rotate(glm::scale(place, glm::vec3(0.15f, 1, 0.15f)), -1.57f, glm::vec3(1, 0, 0));
        if (m.material == 2) place = glm::rotate(place, -1.2f, glm::vec3(1, 0, 0));
        const auto [color, normal] = painted[size_t(m.material)];
        items.push_back({m.mesh, color, normal, m.material == 1 || m.material == 2, place});
    }
    PreviewView view{{0.4f, 0.7f, 6.0f}, {0, 0.35f, 0}, 38, 1280, 720, {0.4f, 0.6f, 0.7f}, true};
    if (Status s = writeBytes(options.previewDirectory + "/terminals.png", encodePng(preview(items, view), 3)); !s)
        return s;
    view.eye = {-4.0f, 2.5f, 3.0f};
    if (Status s = writeBytes(options.previewDirectory + "/terminals_side.png", encodePng(preview(items, view), 3)); !s)
        return s;
    // Leaves over a wall, as growth might lay them.
    items.clear();
    for (uint32_t k = 0; k < 150; ++k) {
        glm::vec3 at(random01(k, 1) * 1.5f - 0.75f, random01(k, 2) * 0.9f - 0.45f, random01(k, 3) * 0.05f);
        glm::mat4 place = glm::translate(glm::mat4(1), at);
        place = glm::rotate(place, (random01(k, 4) - 0.5f) * 2.2f + 3.14f, glm::vec3(0, 0, 1));
        place = glm::rotate(place, 0.35f + 0.5f * random01(k, 5), glm::vec3(1, 0, 0));
        place = glm::scale(place, glm::vec3(0.16f + 0.12f * random01(k, 6)));
        items.push_back({glb.meshes[3 * (k % 3)].mesh, painted[0].color, painted[0].normal, false, place});
    }
    view = {{0.4f, 0.35f, 1.7f}, {0, 0, 0}, 38, 1280, 720, {0.4f, 0.7f, 0.6f}, true};
    if (Status s = writeBytes(options.previewDirectory + "/leaves.png", encodePng(preview(items, view), 3)); !s)
        return s;
    if (Status s = writeBytes(options.previewDirectory + "/leaf_color.png", encodePng(*painted[0].color, 4)); !s)
        return s;
    if (Status s = writeBytes(options.previewDirectory + "/flora_color.png", encodePng(*painted[3].color, 4)); !s)
        return s;
    if (Status s = writeBytes(options.previewDirectory + "/leaf_normal.png", encodePng(*painted[0].normal, 3)); !s)
        return s;
    return writeBytes(options.previewDirectory + "/bark_color.png", encodePng(*painted[1].color, 3));
}

Status writeTerminals(const Options& options) {
    LeafAtlas leaves = paintLeaves(1024), flora = paintFlora(1024);
    Tile bark = paintBark(512), pebbles = paintPebble(256);
    Glb glb;
    glb.images = {
        {"leaf color", encodePng(leaves.color, 4), true},    {"leaf normal", encodePng(leaves.normal, 3), true},
        {"bark color", encodePng(bark.color, 3), true},      {"bark normal", encodePng(bark.normal, 3), true},
        {"pebble color", encodePng(pebbles.color, 3), true}, {"pebble normal", encodePng(pebbles.normal, 3), true},
        {"flora color", encodePng(flora.color, 4), true},    {"flora normal", encodePng(flora.normal, 3), true}};
    glb.materials = {{"leaf", 0, 1, 0.55f, 0.5f, true, false},
                     {"bark", 2, 3, 0.95f, 0, false, true},
                     {"pebble", 4, 5, 0.9f, 0, false, true},
                     {"flora", 6, 7, 0.6f, 0.5f, true, false}};
    std::deque<Mesh> meshes;
    auto add = [&](const std::string& name, Mesh mesh, int material) {
        meshes.push_back(std::move(mesh));
        glb.meshes.push_back({name, &meshes.back(), material});
    };
    auto numbered = [](const char* kind, int variant, int lod) {
        return std::string(kind) + "_" + std::to_string(variant) + "_lod" + std::to_string(lod);
    };
    for (int v = 0; v < kLeafVariants; ++v)
        for (int l = 0; l < kLeafLods; ++l) add(numbered("leaf", v, l), makeLeaf(v, l), 0);
    for (int l = 0; l < kBarkLods; ++l) add("bark_lod" + std::to_string(l), makeBark(l), 1);
    for (int v = 0; v < kPebbleVariants; ++v)
        for (int l = 0; l < kPebbleLods; ++l) add(numbered("pebble", v, l), makePebble(v, l), 2);
    for (int l = 0; l < kFloraLods; ++l) {
        for (int v = 0; v < kOvalVariants; ++v) add(numbered("oval", v, l), makeFlora(kFirstOval + v, l), 3);
        add("blossom_lod" + std::to_string(l), makeFlora(kBlossom, l), 3);
        add("tuft_lod" + std::to_string(l), makeTuft(l), 3);
    }
    if (Status s = writeGlb(options.directory + "/terminals.glb", glb); !s) return s;
    if (options.previewDirectory.empty()) return Done{};
    return previewTerminals(options, glb,
                            {{{&leaves.color, &leaves.normal},
                              {&bark.color, &bark.normal},
                              {&pebbles.color, &pebbles.normal},
                              {&flora.color, &flora.normal}}});
}

Status writeRoofMeshes(const Options& options) {
    const RoofMeshes meshes = makeRoofMeshes();
    Glb glb;
    glb.materials = {{"rough", -1, -1, 0.9f, 0, false, false},
                     {"smooth", -1, -1, 0.7f, 0, false, false},
                     {"glass", -1, -1, 0.1f, 0, false, false}};
    for (const RoofMeshes::Entry& e : meshes.all) glb.meshes.push_back({e.name, &e.mesh, e.material, e.pixels});
    return writeGlb(options.directory + "/roofs.glb", glb);
}

Status writePieces(const Options& options) {
    const PieceMeshes meshes = makePieceMeshes();
    Glb glb;
    glb.materials = {{"rough", -1, -1, 0.9f, 0, false, false}, {"smooth", -1, -1, 0.45f, 0, false, false}};
    for (const PieceMeshes::Entry& e : meshes.all) glb.meshes.push_back({e.name, &e.mesh, e.material});
    return writeGlb(options.directory + "/pieces.glb", glb);
}

// Each form is a surface of its own.
Status writeForms(const Options& options) {
    for (const FormMeshes::Entry& e : makeForms().all) {
        Glb glb;
        glb.materials = {{"clay", -1, -1, 0.8f, 0, false, false}};
        glb.meshes.push_back({e.name, &e.mesh, 0});
        if (Status s = writeGlb(options.directory + "/" + e.name + ".glb", glb); !s) return s;
    }
    return Done{};
}

Status writeProps(const Options& options) {
    const PropMeshes meshes = makePropMeshes();
    Glb glb;
    glb.images = {{"foliage", encodePng(paintFoliage(1024), 4), true},
                  {"palette", encodePng(paintPalette(), 3), true},
                  {"stones", encodeJpeg(paintFallenStones(), 90), false}};
    glb.materials = {{"foliage", 0, -1, 0.7f, 0.57f, true, true},
                     {"built", 1, -1, 0.92f, 0, false, false},
                     {"grass", -1, -1, 0.8f, 0, true, false},
                     {"meadow", 0, -1, 0.7f, 0.57f, true, true},
                     {"fallen", 2, -1, 0.92f, 0, false, false}};
    for (const PropMeshes::Entry& e : meshes.all) glb.meshes.push_back({e.name, &e.mesh, e.material});
    return writeGlb(options.directory + "/props.glb", glb);
}

Status writeSite(const Options& options) {
    Result<std::vector<Outline>> houses = readOutlines(options.town);
    if (!houses) return houses.failure();
    Result<std::vector<Door>> doors = findDoors(options.town, options.grammar);
    if (!doors) return doors.failure();
    const Site site = makeSite(*houses, *doors, 512);
    if (Status s = writeBytes(options.directory + "/site.png", encodePng(site.map, 3)); !s) return s;
    const std::string text = siteJson(site);
    return writeBytes(options.directory + "/site.json", {text.begin(), text.end()});
}

}  // namespace

Status generate(const Options& options) {
    if (Status s = makeDirectory(options.directory); !s) return s;
    if (!options.previewDirectory.empty())
        if (Status s = makeDirectory(options.previewDirectory); !s) return s;
    // First, since it is what can be wrong with what is asked for.
    if (!options.town.empty())
        if (Status s = writeSite(options); !s) return s;
    auto wanted = [&](const char* part) { return options.only.empty() || options.only == part; };
    if (wanted("ruin"))
        if (Status s = writeRuin(options); !s) return s;
    if (wanted("roofs"))
        if (Status s = writeRoofMeshes(options); !s) return s;
    if (wanted("pieces"))
        if (Status s = writePieces(options); !s) return s;
    if (wanted("forms"))
        if (Status s = writeForms(options); !s) return s;
    if (wanted("props"))
        if (Status s = writeProps(options); !s) return s;
    return wanted("terminals") ? writeTerminals(options) : Status(Done{});
}

}  // namespace espalier::content
