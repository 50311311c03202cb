// In: models. Out: one .glb with KIND_lodN meshes, each with one material.
#include "tools/bake/main/palette.hpp"

#include <meshoptimizer.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <map>
#include <optional>

#include "shaders/emit/emit_records.h"
#include "tools/bake/main/folder.hpp"
#include "tools/content/glb.hpp"

namespace espalier {
namespace {

constexpr uint32_t kPlainSide = 8, kPictureSide = 256, kMostSide = 1024;  // texels of a material in the piece's picture
constexpr size_t kMostVertices = 65'536;                                  // of a level
constexpr size_t kColliderTriangles = 96;                                 // of a level fine enough to meet others by
constexpr size_t kMostOfTerminal = 2'000, kFewestOfTerminal = 8;          // triangles
constexpr size_t kMostPieces = kMaxTerminalKinds - 1;

struct Piece {
    std::string name;
    std::vector<content::Mesh> lods;
    std::optional<content::Mesh> collider;  // by which it meets others, if no level is coarse enough
    content::Picture picture;
    bool repeats = false;  // the picture is a material's own
    bool cutOut = false;   // by its alpha
    float roughness = 1;
};

std::string nameOf(const std::string& file) {
    std::string name;
    for (const char c : std::filesystem::path(file).stem().string())
        if (std::isalnum(static_cast<unsigned char>(c))) name += c;
    if (name.empty() || std::isdigit(static_cast<unsigned char>(name[0]))) name = "piece" + name;
    return name;
}

uint8_t stored(float linear) {
    const float c = std::clamp(linear, 0.0f, 1.0f);
    const float s = c <= .0031308f ? 12.92f * c : 1.055f * std::pow(c, 1 / 2.4f) - .055f;
    return uint8_t(s * 255 + .5f);
}
float linear(uint8_t stored) {
    const float s = float(stored) / 255;
    return s <= .04045f ? s / 12.92f : std::pow((s + .055f) / 1.055f, 2.4f);
}

// The mean of the source's texels that a texel of a side so long covers, times a colour. cutOut: what is transparent
// stays so, and doesn't darken its edge.
void paint(content::Picture& to, uint32_t left, uint32_t top, uint32_t side, const Picture* from, glm::vec4 colour,
           bool cutOut) {
    for (uint32_t y = 0; y < side; ++y)
        for (uint32_t x = 0; x < side; ++x) {
            glm::vec3 sum(0);
            float count = 0, weight = 0;
            if (from) {
                const uint32_t x0 = x * from->width / side, y0 = y * from->height / side;
                const uint32_t x1 = std::max((x + 1) * from->width / side, x0 + 1);
                const uint32_t y1 = std::max((y + 1) * from->height / side, y0 + 1);
                for (uint32_t v = y0; v < y1; ++v)
                    for (uint32_t u = x0; u < x1; ++u, ++count) {
                        const uint8_t* t = &from->rgba[(size_t(v) * from->width + u) * 4];
                        const float share = cutOut ? std::max(float(t[3]) / 255, 1e-3f) : 1;
                        sum += share * glm::vec3(linear(t[0]), linear(t[1]), linear(t[2]));
                        weight += share;
                    }
            }
            const glm::vec3 mean = (count > 0 ? sum / weight : glm::vec3(1)) * glm::vec3(colour);
            uint8_t* t = to.at(int(left + x), int(top + y));
            for (int c = 0; c < 3; ++c) t[c] = stored(mean[c]);
            t[3] = cutOut && count > 0 ? uint8_t(std::clamp(weight / count, 0.0f, 1.0f) * 255 + .5f) : 255;
        }
}

// Where each material's colours lie in the piece's one picture: cells of a square, or the whole picture.
class Colours {
  public:
    Colours(const Model& model, Piece& piece, bool cutOut) : model_(model) {
        for (size_t t = 0; t < model.indices.size() / 3; ++t) cells_.emplace(materialOf(t), uint32_t(cells_.size()));
        bool pictured = false;
        float rough = 0;
        for (const auto& [material, cell] : cells_) {
            pictured = pictured || pictureOf(material);
            rough += roughnessOf(material) / float(cells_.size());
        }
        piece.roughness = rough;
        whole_ = cells_.size() == 1;
        side_ = pictured ? kPictureSide : kPlainSide;
        if (const Picture* only = whole_ ? pictureOf(cells_.begin()->first) : nullptr)
            side_ = std::min(kMostSide, std::max(only->width, only->height));
        piece.repeats = whole_ && pictured;
        columns_ = uint32_t(std::ceil(std::sqrt(double(cells_.size()))));
        piece.picture = content::Picture(int(columns_ * side_), int(columns_ * side_));
        for (const auto& [material, cell] : cells_)
            paint(piece.picture, cell % columns_ * side_, cell / columns_ * side_, side_, pictureOf(material),
                  material < model.materials.size() ? model.materials[material].baseColor : glm::vec4(1), cutOut);
    }

    uint32_t materialOf(size_t triangle) const {
        return triangle < model_.triangleMaterial.size() ? model_.triangleMaterial[triangle] : 0;
    }
    glm::vec2 uvOf(uint32_t material, uint32_t vertex) const {
        const std::vector<glm::vec2>& all = model_.materialUvs.empty() ? model_.uvs : model_.materialUvs;
        glm::vec2 uv = vertex < all.size() ? all[vertex] : glm::vec2(.5f);
        if (!std::isfinite(uv.x) || !std::isfinite(uv.y) || !pictureOf(material)) uv = glm::vec2(.5f);
        if (whole_) return uv;
        // Half a texel from the cell's edge, so that filtering takes nothing of its neighbours.
        const float inner = 1 - 1 / float(side_);
        const glm::vec2 within = glm::vec2(.5f / float(side_)) + (uv - glm::floor(uv)) * inner;
        const uint32_t cell = cells_.at(material);
        return (glm::vec2(cell % columns_, cell / columns_) + within) / float(columns_);
    }

  private:
    const Picture* pictureOf(uint32_t material) const {
        const int image = material < model_.materials.size() ? model_.materials[material].baseColorImage : -1;
        return image >= 0 && size_t(image) < model_.images.size() && !model_.images[size_t(image)].rgba.empty()
                   ? &model_.images[size_t(image)]
                   : nullptr;
    }
    float roughnessOf(uint32_t material) const {
        return material < model_.materials.size() ? model_.materials[material].roughness : 1;
    }

    const Model& model_;
    std::map<uint32_t, uint32_t> cells_;  // by material
    uint32_t side_ = 0, columns_ = 1;
    bool whole_ = false;
};

std::vector<glm::vec3> normalsOf(const Model& model) {
    if (!model.normals.empty()) return model.normals;
    std::vector<glm::vec3> normals(model.positions.size(), glm::vec3(0));
    for (size_t i = 0; i + 2 < model.indices.size(); i += 3) {
        const uint32_t* t = &model.indices[i];
        const glm::vec3 n =
            glm::cross(model.positions[t[1]] - model.positions[t[0]], model.positions[t[2]] - model.positions[t[0]]);
        for (int k = 0; k < 3; ++k) normals[t[k]] += n;
    }
    for (glm::vec3& n : normals) n = glm::length(n) > 0 ? glm::normalize(n) : glm::vec3(0, 1, 0);
    return normals;
}

// How a model is laid into the frame of a mesh: turned, its foot moved to the origin, scaled.
struct Frame {
    glm::mat3 axes{1};
    glm::vec3 foot{0};  // turned already
    float side = 0;
};

struct Extent {
    glm::vec3 low{1e30f}, high{-1e30f};
    glm::vec3 size() const { return high - low; }
};
Extent extentOf(const Model& model, const glm::mat3& axes) {
    Extent out;
    for (const uint32_t v : model.indices) {
        const glm::vec3 p = axes * model.positions[v];
        out.low = glm::min(out.low, p);
        out.high = glm::max(out.high, p);
    }
    return out;
}

// A piece fills its scope.
Frame pieceFrame(const Model& model) {
    const Extent all = extentOf(model, glm::mat3(1));
    const glm::vec3 size = all.size();
    return {glm::mat3(1),
            {(all.low.x + all.high.x) / 2, all.low.y, (all.low.z + all.high.z) / 2},
            std::max(std::max(size.x, size.z), size.y * 1e-3f)};
}

// A leaf has its stalk at the origin, leads along +Y and looks along +Z. One that lies on the ground leads away from
// who looks at it from the front, as modelling programs lay it; one that is thin from left to right looks to the right.
Frame leafFrame(const Model& model) {
    const glm::vec3 size = extentOf(model, glm::mat3(1)).size();
    Frame frame;
    if (size.y < .5f * std::min(size.x, size.z))
        frame.axes = glm::transpose(glm::mat3(glm::vec3(1, 0, 0), glm::vec3(0, 0, -1), glm::vec3(0, 1, 0)));
    else if (size.x < .5f * std::min(size.y, size.z))
        frame.axes = glm::transpose(glm::mat3(glm::vec3(0, 0, -1), glm::vec3(0, 1, 0), glm::vec3(1, 0, 0)));
    const Extent turned = extentOf(model, frame.axes);
    frame.side = std::max(turned.size().y, turned.size().x / 3);
    // The stalk is the middle of what lies lowest.
    Extent stalk;
    for (const uint32_t v : model.indices) {
        const glm::vec3 p = frame.axes * model.positions[v];
        if (p.y <= turned.low.y + .02f * frame.side)
            stalk.low = glm::min(stalk.low, p), stalk.high = glm::max(stalk.high, p);
    }
    const glm::vec3 middle = .5f * (stalk.low + stalk.high);
    frame.foot = {middle.x, turned.low.y, middle.z};
    return frame;
}

// Vertices apart for each material, in the mesh's frame.
Result<content::Mesh> wholeOf(const Model& model, const Colours& colours, const Frame& frame) {
    if (!(frame.side > 0)) return Failure(model.name, "has no size");
    const std::vector<glm::vec3> normals = normalsOf(model);
    content::Mesh mesh;
    std::map<std::pair<uint32_t, uint32_t>, uint32_t> known;  // by vertex and material
    for (size_t i = 0; i < model.indices.size(); ++i) {
        const uint32_t v = model.indices[i], material = colours.materialOf(i / 3);
        const auto [at, fresh] = known.emplace(std::pair(v, material), uint32_t(mesh.positions.size()));
        if (fresh) {
            mesh.positions.push_back((frame.axes * model.positions[v] - frame.foot) / frame.side);
            mesh.normals.push_back(frame.axes * normals[v]);
            mesh.uvs.push_back(colours.uvOf(material, v));
        }
        mesh.indices.push_back(at->second);
    }
    return mesh;
}

// One vertex at each place of the picture and the shape, whatever its normals: the edges of flat faces would hold them
// fast when the mesh is made coarser.
content::Mesh welded(const content::Mesh& mesh) {
    content::Mesh out;
    std::map<std::array<float, 5>, uint32_t> known;
    for (const uint32_t v : mesh.indices) {
        const glm::vec3 p = mesh.positions[v];
        const auto [at, fresh] =
            known.emplace(std::array{p.x, p.y, p.z, mesh.uvs[v].x, mesh.uvs[v].y}, uint32_t(out.positions.size()));
        if (fresh) {
            out.positions.push_back(p);
            out.uvs.push_back(mesh.uvs[v]);
            out.normals.push_back(glm::vec3(0));
        }
        out.normals[at->second] += mesh.normals[v];
        out.indices.push_back(at->second);
    }
    for (glm::vec3& n : out.normals) n = glm::length(n) > 0 ? glm::normalize(n) : glm::vec3(0, 1, 0);
    return out;
}

// So many triangles, or about as many as the shape allows.
content::Mesh simplified(const content::Mesh& mesh, size_t triangles) {
    std::vector<uint32_t> indices(mesh.indices.size());
    float error = 0;
    size_t count = meshopt_simplify(indices.data(), mesh.indices.data(), mesh.indices.size(), &mesh.positions[0].x,
                                    mesh.positions.size(), sizeof(glm::vec3), triangles * 3, .3f, 0, &error);
    indices.resize(count);
    content::Mesh out;
    std::map<uint32_t, uint32_t> known;
    for (const uint32_t v : indices) {
        const auto [at, fresh] = known.emplace(v, uint32_t(out.positions.size()));
        if (fresh) {
            out.positions.push_back(mesh.positions[v]);
            out.normals.push_back(mesh.normals[v]);
            out.uvs.push_back(mesh.uvs[v]);
        }
        out.indices.push_back(at->second);
    }
    return out;
}

content::Mesh boxAround(const content::Mesh& mesh) {
    glm::vec3 low(1e30f), high(-1e30f);
    for (const glm::vec3& p : mesh.positions) low = glm::min(low, p), high = glm::max(high, p);
    content::Mesh box;
    for (int i = 0; i < 8; ++i) {
        box.positions.emplace_back(i & 1 ? high.x : low.x, i & 2 ? high.y : low.y, i & 4 ? high.z : low.z);
        box.normals.push_back(glm::normalize(box.positions.back() - (low + high) * .5f + glm::vec3(0, 1e-6f, 0)));
        box.uvs.emplace_back(.5f, .5f);
    }
    for (const uint32_t i :
         {0, 2, 3, 0, 3, 1, 4, 5, 7, 4, 7, 6, 0, 1, 5, 0, 5, 4, 2, 6, 7, 2, 7, 3, 0, 4, 6, 0, 6, 2, 1, 3, 7, 1, 7, 5})
        box.indices.push_back(i);
    return box;
}

// Coarser levels, as long as they save a quarter, down to about so many triangles.
void addLevels(Piece& piece, const content::Mesh& whole, size_t fewest) {
    const content::Mesh joined = welded(whole);
    for (size_t wanted = whole.indices.size() / 3 / 4; piece.lods.size() < kMaxLods; wanted /= 4) {
        const size_t before = piece.lods.back().indices.size() / 3;
        if (before <= fewest) break;
        content::Mesh lod = simplified(joined, std::max(wanted, fewest));
        if (lod.indices.empty() || lod.indices.size() / 3 > before * 3 / 4) break;
        piece.lods.push_back(std::move(lod));
    }
}

// What a plant draws thousands of times.
Result<Piece> terminalOf(const std::string& file, const ImportOptions& importing) {
    Result<Model> model = importModel(file, importing);
    if (!model) return model.failure();
    if (model->indices.empty()) return Failure(file, "has no triangles");
    Piece piece;
    piece.name = "own";
    const Colours colours(*model, piece, true);
    Result<content::Mesh> whole = wholeOf(*model, colours, leafFrame(*model));
    if (!whole) return whole.failure();
    const bool large = whole->indices.size() / 3 > kMostOfTerminal;
    piece.lods.push_back(large ? simplified(welded(*whole), kMostOfTerminal) : *whole);
    if (piece.lods[0].indices.size() / 3 > 4 * kMostOfTerminal)
        return Failure(file, "has " + std::to_string(whole->indices.size() / 3) +
                                 " triangles and can't be simplified; a plant draws its leaves thousands of times, so "
                                 "one should have a few hundred");
    addLevels(piece, piece.lods[0], kFewestOfTerminal);
    const auto& texels = piece.picture.rgba;
    for (size_t i = 3; i < texels.size() && !piece.cutOut; i += 4) piece.cutOut = texels[i] < 128;
    return piece;
}

Result<Piece> pieceOf(const std::string& file, const ImportOptions& importing) {
    Result<Model> model = importModel(file, importing);
    if (!model) return model.failure();
    if (model->indices.empty()) return Failure(file, "has no triangles");
    Piece piece;
    piece.name = nameOf(file);
    const Colours colours(*model, piece, false);
    Result<content::Mesh> whole = wholeOf(*model, colours, pieceFrame(*model));
    if (!whole) return whole.failure();
    const bool large = whole->positions.size() > kMostVertices;
    piece.lods.push_back(large ? simplified(*whole, kMostVertices / 2) : *whole);
    if (piece.lods[0].positions.size() > kMostVertices)
        return Failure(file, "has more than 65,536 vertices, and can't be simplified");
    addLevels(piece, *whole, kColliderTriangles);
    if (piece.lods.back().indices.size() / 3 > kColliderTriangles) piece.collider = boxAround(*whole);
    return piece;
}

Result<std::vector<std::string>> filesOf(const PaletteArguments& arguments) {
    std::error_code ignored;
    if (!std::filesystem::is_directory(arguments.input, ignored)) return std::vector<std::string>{arguments.input};
    Result<std::vector<folder::Item>> items = folder::listModels(arguments.input, arguments.output);
    if (!items) return items.failure();
    std::vector<std::string> files;
    for (const folder::Item& item : *items) {
        const std::string file = (std::filesystem::path(arguments.input) / item.model).string();
        if (!std::filesystem::equivalent(file, arguments.output, ignored)) files.push_back(file);
    }
    if (files.size() > kMostPieces)
        return Failure(arguments.input, "holds " + std::to_string(files.size()) +
                                            " models, and a palette has room for " + std::to_string(kMostPieces));
    return files;
}

void addPiece(content::Glb& glb, const Piece& piece) {
    content::GlbMaterial material;
    material.name = piece.name;
    material.colorImage = int(glb.images.size());
    material.roughness = piece.roughness;
    material.repeat = piece.repeats;
    material.doubleSided = piece.cutOut;
    material.alphaCutoff = piece.cutOut ? .5f : 0;
    glb.images.push_back({piece.name, content::encodePng(piece.picture, piece.cutOut ? 4 : 3), true});
    for (size_t lod = 0; lod < piece.lods.size(); ++lod)
        glb.meshes.push_back({piece.name + "_lod" + std::to_string(lod), &piece.lods[lod], int(glb.materials.size())});
    if (piece.collider)
        glb.meshes.push_back({piece.name + "_collider_lod0", &*piece.collider, int(glb.materials.size())});
    glb.materials.push_back(material);
}

}  // namespace

Status bakeTerminal(const PaletteArguments& arguments, const std::function<void(const std::string&)>& told) {
    const Result<Piece> piece = terminalOf(arguments.input, arguments.importing);
    if (!piece) return piece.failure();
    told("terminal: " + std::to_string(piece.value().lods[0].indices.size() / 3) + " triangles, " +
         std::to_string(piece.value().lods.size()) + " levels, of " + arguments.input);
    content::Glb glb;
    addPiece(glb, piece.value());
    return content::writeGlb(arguments.output, glb);
}

Status bakePalette(const PaletteArguments& arguments, const std::function<void(const std::string&)>& told) {
    const Result<std::vector<std::string>> files = filesOf(arguments);
    if (!files) return files.failure();
    std::vector<Piece> pieces;
    std::map<std::string, uint32_t> named;
    for (const std::string& file : files.value()) {
        Result<Piece> piece = pieceOf(file, arguments.importing);
        if (!piece) return piece.failure();
        if (const uint32_t before = named[piece->name]++) piece->name += "x" + std::to_string(before + 1);
        told(piece->name + ": " + std::to_string(piece->lods[0].indices.size() / 3) + " triangles, " +
             std::to_string(piece->lods.size()) + " levels, of " + file);
        pieces.push_back(std::move(*piece));
    }
    content::Glb glb;
    for (const Piece& piece : pieces) addPiece(glb, piece);
    return content::writeGlb(arguments.output, glb);
}

}  // namespace espalier
