// In: baked surfaces, which are glTF. Out: of each what is drawn, under the numbers of another file.
#include "tools/export/surfaces.hpp"

#include <algorithm>
#include <cstring>
#include <filesystem>
#include <map>
#include <stdexcept>

#include "tools/export/placing.hpp"

namespace espalier::exporting {
namespace {

uint32_t wordAt(const std::string& bytes, size_t at) {
    uint32_t word = 0;
    if (at + sizeof word > bytes.size()) throw std::runtime_error("the file ends too early");
    std::memcpy(&word, bytes.data() + at, sizeof word);
    return word;
}

// Copies objects of one document, each once, with what they refer to.
class Copier {
  public:
    Copier(const std::string& bytes, GltfFile& to) : bytes_(bytes), to_(to) {
        const size_t json = wordAt(bytes, 12);
        if (20 + json > bytes.size()) throw std::runtime_error("the file ends too early");
        from_ = Json::parse(bytes.begin() + 20, bytes.begin() + 20 + std::ptrdiff_t(json));
        binary_ = 20 + json + 8;
        for (const Json& extension : from_.value("extensionsUsed", Json::array())) {
            const std::string name = extension;
            const Json required = from_.value("extensionsRequired", Json::array());
            if (!name.starts_with("ESPALIER_")) to_.use(name, std::ranges::find(required, extension) != required.end());
        }
    }

    // Of all nodes of the scene.
    std::vector<size_t> meshes() {
        std::vector<size_t> out;
        for (const Json& root : from_.at("scenes").at(0).at("nodes"))
            if (const Json& node = from_.at("nodes").at(size_t(root)); node.contains("mesh"))
                out.push_back(mesh(node["mesh"]));
        return out;
    }

  private:
    size_t mesh(size_t number) {
        return once("meshes", number, [&](Json& mesh) {
            for (Json& primitive : mesh.at("primitives")) {
                for (Json& attribute : primitive.at("attributes")) attribute = accessor(attribute);
                refer(primitive, "indices", [&](size_t i) { return accessor(i); });
                refer(primitive, "material", [&](size_t i) { return material(i); });
                if (primitive.contains("extensions"))
                    for (Json& extension : primitive["extensions"])
                        refer(extension, "bufferView", [&](size_t i) { return view(i); });
            }
        });
    }
    size_t accessor(size_t number) {
        return once("accessors", number,
                    [&](Json& accessor) { refer(accessor, "bufferView", [&](size_t i) { return view(i); }); });
    }
    size_t view(size_t number) {
        const auto [known, added] = known_.try_emplace({"bufferViews", number}, 0);
        if (!added) return known->second;
        const Json& from = from_.at("bufferViews").at(number);
        const size_t offset = from.value("byteOffset", size_t(0)), size = from.at("byteLength");
        if (binary_ + offset + size > bytes_.size()) throw std::runtime_error("the file ends too early");
        known->second = to_.view(bytes_.data() + binary_ + offset, size, from.value("target", GltfFile::kOther));
        if (from.contains("byteStride")) to_.json()["bufferViews"][known->second]["byteStride"] = from["byteStride"];
        return known->second;
    }
    size_t material(size_t number) {
        return once("materials", number, [&](Json& material) { takeTextures(material); });
    }
    // References to textures lie anywhere in a material, of extensions too.
    void takeTextures(Json& object) {
        for (auto& [name, value] : object.items()) {
            if (name.ends_with("Texture")) refer(value, "index", [&](size_t i) { return texture(i); });
            if (value.is_object()) takeTextures(value);
        }
    }
    size_t texture(size_t number) {
        return once("textures", number, [&](Json& texture) {
            refer(texture, "sampler", [&](size_t i) { return once("samplers", i, [](Json&) {}); });
            refer(texture, "source", [&](size_t i) { return image(i); });
            if (texture.contains("extensions"))
                for (Json& extension : texture["extensions"])
                    refer(extension, "source", [&](size_t i) { return image(i); });
        });
    }
    size_t image(size_t number) {
        return once("images", number,
                    [&](Json& image) { refer(image, "bufferView", [&](size_t i) { return view(i); }); });
    }

    template <class F>
    size_t once(const char* list, size_t number, F&& change) {
        const auto [known, added] = known_.try_emplace({list, number}, 0);
        if (!added) return known->second;
        Json object = from_.at(list).at(number);
        change(object);
        return known->second = to_.add(list, std::move(object));
    }
    template <class F>
    static void refer(Json& object, const char* name, F&& number) {
        if (object.contains(name)) object[name] = number(object[name].template get<size_t>());
    }

    const std::string& bytes_;
    GltfFile& to_;
    Json from_;
    size_t binary_ = 0;  // where its buffer begins
    std::map<std::pair<std::string, size_t>, size_t> known_;
};

}  // namespace

bool addSurfaces(const std::vector<ExportSurface>& surfaces, GltfFile& file, std::vector<size_t>& nodes,
                 std::string& error) {
    std::map<std::string, std::vector<size_t>> known;  // by file: what stands several times is there once
    for (const ExportSurface& surface : surfaces) {
        try {
            const auto [meshes, added] = known.try_emplace(surface.name);
            if (added) meshes->second = Copier(surface.bytes, file).meshes();
            for (size_t mesh : meshes->second) {
                std::string text = "\"mesh\":" + std::to_string(mesh);
                appendText(text, "name", std::filesystem::path(surface.name).stem().stem().string());
                const std::string place = placeText(surface.place);
                nodes.push_back(file.node(place.empty() ? text : text + "," + place));
            }
        } catch (const std::exception& e) {
            error = surface.name + ": can't be taken over: " + e.what();
            return false;
        }
    }
    return true;
}

}  // namespace espalier::exporting
