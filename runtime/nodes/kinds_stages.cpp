// Stages of Espalier as nodes: what they give are wishes, which runtime/plugin fulfils.
#include "runtime/grammar/grammar.hpp"
#include "runtime/nodes/function_text.hpp"
#include "runtime/nodes/node_work.hpp"
#include "shaders/shared/random.h"

namespace espalier {
namespace {

constexpr float kFar = 1e6f;  // metres
constexpr size_t kMostPlants = 65536;
constexpr size_t kMostTownBytes = 256u << 20;
constexpr uint32_t kBaked = 0x62616B65;  // begins the keys of baked meshes

// Of a file that the port names: where it lies, and what it says.
Status readText(const NodeWork& work, size_t most, std::string& path, std::string& text) {
    if (work.text("file").empty()) return Failure("", "'file' names no file");
    Result<NodeFile> file = work.file("file");
    if (!file) return file.failure();
    if (file->bytes.size() > most) return Failure("", work.text("file") + ": the file is too long");
    path = std::move(file->path);
    text.assign(reinterpret_cast<const char*>(file->bytes.data()), file->bytes.size());
    return Done{};
}

Status makeGrammar(NodeWork& work) {
    auto wish = std::make_shared<RulesWish>();
    if (Status read = readText(work, kMaxGrammarBytes, wish->file, wish->text); !read) return read;
    work.give(RulesRef(std::move(wish)));
    return Done{};
}

Status giveWithParam(NodeWork& work, WishedParam param) {
    if (param.name.empty()) return Failure("", "'name' names no parameter");
    auto wish = std::make_shared<RulesWish>(*work.wish<RulesWish>("grammar"));
    std::erase_if(wish->params, [&](const WishedParam& p) { return p.name == param.name; });
    wish->params.push_back(std::move(param));
    work.give(RulesRef(std::move(wish)));
    return Done{};
}
Status makeParameter(NodeWork& work) {
    return giveWithParam(work, {work.text("name"), glm::vec3(work.number("value"), 0, 0), 1});
}
Status makeColourParameter(NodeWork& work) {
    return giveWithParam(work, {work.text("name"), work.vector("colour"), 3});
}

uint64_t keyOf(const GroundWish& wish) {
    uint64_t key = combineKeys(kBaked, wish.resolution);
    const auto add = [&](const void* words, size_t bytes) {
        for (size_t i = 0; i + 4 <= bytes; i += 4) {
            uint32_t word;
            std::memcpy(&word, static_cast<const char*>(words) + i, 4);
            key = combineKeys(key, word);
        }
    };
    add(wish.places.data(), wish.places.size() * sizeof(glm::vec3));
    add(wish.corners.data(), wish.corners.size() * 4);
    add(&wish.material, sizeof wish.material);
    return key | 1;
}

Status makeBake(NodeWork& work) {
    auto wish = std::make_shared<GroundWish>();
    wish->resolution = work.whole("resolution");
    for (const GeometryPart& part : work.geometry("mesh")) {
        if (part.kind != GeometryPart::Kind::mesh) continue;
        Result<NodeWork::WholeMesh> mesh = work.wholeMeshNow(part);
        if (!mesh) return mesh.failure();
        const uint32_t first = uint32_t(wish->places.size());
        if (first + mesh->places.size() > kMostNodeElements)
            return Failure("", "has more than 67,108,864 vertices, which are more than there is room for");
        wish->places.insert(wish->places.end(), mesh->places.begin(), mesh->places.end());
        for (const uint32_t corner : mesh->corners) wish->corners.push_back(first + corner);
        wish->material = part.material;
        wish->shown.push_back(part);
    }
    if (wish->corners.empty()) return Failure("", "'mesh' holds no triangles");
    wish->key = keyOf(*wish);
    work.give(GroundRef(std::move(wish)));
    return Done{};
}

Status makeGrow(NodeWork& work) {
    auto wish = std::make_shared<PlantsWish>();
    wish->rules = work.wish<RulesWish>("grammar");
    wish->ground = work.wish<GroundWish>("ground");
    wish->direction = work.vector("direction");
    wish->reach = work.number("reach");
    wish->seed = work.whole("seed");
    for (const GeometryPart& part : work.geometry("points")) {
        Result<std::vector<glm::vec3>> places = work.placesNow(part);
        if (!places) return places.failure();
        wish->points.insert(wish->points.end(), places->begin(), places->end());
        if (wish->points.size() > kMostPlants)
            return Failure("", std::to_string(wish->points.size()) + " plants are more than 65,536; Filter the points");
    }
    work.give(PlantsRef(std::move(wish)));
    return Done{};
}

Status makeTown(NodeWork& work) {
    auto wish = std::make_shared<TownWish>();
    if (Status read = readText(work, kMostTownBytes, wish->file, wish->text); !read) return read;
    wish->rules = work.wish<RulesWish>("grammar");
    work.give(TownRef(std::move(wish)));
    return Done{};
}

Status makeTownLayer(NodeWork& work) {
    auto wish = std::make_shared<CoverWish>();
    wish->layer = work.text("name");
    if (wish->layer.empty()) return Failure("", "'name' names no layer");
    if (Status made = assign(wish->code, compileFunction({work.text("value"), "0", "0"})); !made) return made;
    wish->inputs = {work.number("a"), work.number("b"), work.number("c")};
    work.give(CoverRef(std::move(wish)));
    return Done{};
}

}  // namespace

std::vector<NodeKind> stageKinds() {
    const NodePort grammar = wirePort("grammar", ValueType::rules, "what the parameter belongs to");
    const NodePort name{"name", ValueType::text, "", 0, 0, "", "of the parameter, as the grammar's text has it"};
    NodePort ground = wirePort("ground", ValueType::ground, "wait until this is baked; else plants take what there is");
    ground.optional = true;
    const auto number = [](const char* port) {
        return numberPort(port, 0, -kFar, kFar, "", "wire numbers to it, such as time");
    };
    return {
        {"Grammar",
         "A grammar of plants or patterns, for Grow.",
         {{"file", ValueType::file, "", 0, 0, "", "beside the graph's own file"}},
         {{"grammar", ValueType::rules}},
         makeGrammar},
        {"Parameter",
         "The same grammar with another value of a parameter. Wire numbers to it, such as time.",
         {grammar, name, numberPort("value", 1, -kFar, kFar, "", "is drawn to the parameter's own range")},
         {{"grammar", ValueType::rules}},
         makeParameter},
        {"ColourParameter",
         "The same grammar with another colour of a parameter.",
         {grammar, name, {"colour", ValueType::colour, glm::vec3(0.5f), 0, 1, "", "linear: red, green and blue"}},
         {{"grammar", ValueType::rules}},
         makeColourParameter},
        {"Bake",
         "The mesh becomes ground for plants: a surface of the scene. That takes seconds, beside the frames, and once "
         "for each mesh; until then the mesh itself is shown.",
         {wirePort("mesh", ValueType::geometry, "with all its instances"),
          wholePort("resolution", 512, 64, 4096, "texels a side: the more, the finer plants follow it")},
         {{"ground", ValueType::ground}},
         makeBake},
        {"Grow",
         "A plant or a pattern at each point, each sample of curves or each vertex of a mesh, where ground is near.",
         {wirePort("points", ValueType::geometry, "where"), wirePort("grammar", ValueType::rules, "by which rules"),
          ground, vectorPort("direction", glm::vec3(0), -kFar, kFar, "", "of first stems; (0, 0, 0) is upwards"),
          numberPort("reach", 1, 0, kFar, "m", "from a point to the ground at most"), seedPort()},
         {{"plants", ValueType::plants}},
         makeGrow},
        {"Town",
         "Houses from footprints, as GeoJSON or a plan in metres, with roofs by a grammar. A scene has one town.",
         {{"file", ValueType::file, "", 0, 0, "", "beside the graph's own file"},
          wirePort("grammar", ValueType::rules, "of roofs")},
         {{"town", ValueType::town}},
         makeTown},
        {"TownLayer",
         "What a painted layer over the town holds, as an expression of the place: moss, decay, another covering. It "
         "knows x and z in metres, y of the ground, and else what Function knows.",
         {{"name", ValueType::text, "", 0, 0, "", "of the layer, as the grammar's text has it"},
          {"value", ValueType::text, "0.5 + noise(x, 0, z)", 0, 0, "", "0 to 1; less is 0, more is 1"},
          number("a"),
          number("b"),
          number("c")},
         {{"layer", ValueType::cover}},
         makeTownLayer},
    };
}

}  // namespace espalier
