// In: a PLY file (text, or binary of either byte order). Out: its polygons and strips as triangles, with normals, UVs,
// colours and pictures where it has them. Elements and properties that we don't know are passed over; what reaches past
// the file's end or names vertices that aren't there is an error at a line of the text, or at a byte of the binary
// part.
#include <algorithm>
#include <array>
#include <bit>

#include "tools/bake/import_polygons.hpp"
#include "tools/formats/ply_file.hpp"

namespace espalier::import {
namespace {

using formats::PlyElement;
using formats::PlyFile;
using formats::PlyNames;
using formats::PlyType;

// A vertex's properties that are read, by their place in a row: position, normal, UV, colour.
constexpr size_t kNormal = 3, kUv = 6, kColour = 8, kAlpha = 11, kSlots = 12;
constexpr std::array<PlyNames, kSlots> kVertexNames = {{{"x"},
                                                        {"y"},
                                                        {"z"},
                                                        {"nx"},
                                                        {"ny"},
                                                        {"nz"},
                                                        {"u", "s", "texture_u"},
                                                        {"v", "t", "texture_v"},
                                                        {"red", "diffuse_red", "r"},
                                                        {"green", "diffuse_green", "g"},
                                                        {"blue", "diffuse_blue", "b"},
                                                        {"alpha", "diffuse_alpha", "a"}}};

constexpr double kUnsignedRestart = 4294967295.0;  // what -1 is as an unsigned number

// Whole numbers of 8 and 16 bits are shares of the most that they can be.
double shareOf(double value, PlyType type) {
    return type == PlyType::uint8 ? value / 255 : type == PlyType::uint16 ? value / 65535 : value;
}

class PlyReader {
  public:
    PlyReader(const std::string& path, Bytes file, const ImportOptions& options, Intake& intake, Model& model)
        : path_(path),
          options_(options),
          intake_(intake),
          file_({reinterpret_cast<const char*>(file.data()), file.size()}),
          model_(model),
          blemishes_(path) {}

    Status run() {
        Status done = told(file_.readHeader());
        if (!done) return done;
        readTextures();
        splits_ = std::ranges::any_of(file_.elements, [](const PlyElement& element) {
            return element.name == "face" &&
                   (element.find({"texcoord"}) >= 0 || element.find(kVertexNames[kColour]) >= 0);
        });
        for (const PlyElement& element : file_.elements) {
            done = read(element);
            if (!done) return done;
        }
        if (polygons_.empty()) return Failure(path_, "the file holds no faces");
        for (const glm::dvec3& p : positions_)
            if (!isPlace(p)) blemishes_.note("a vertex whose position is not a number, named by no face");
        // Not every element of vertices need have them.
        if (model_.normals.size() != positions_.size()) model_.normals.clear();
        if (model_.uvs.size() != positions_.size()) model_.uvs.clear();
        if (model_.colours.size() != positions_.size()) model_.colours.clear();
        if (splits_) takeSplitVertices();
        settle(splits_ ? places_ : positions_, polygons_.corners(), options_.origin, model_);
        polygons_.fill(model_);
        makeColoursLinear(model_);
        if (model_.materials.empty()) model_.materials.emplace_back();
        if (model_.materials.size() == 1) model_.triangleMaterial.clear();
        blemishes_.tell(model_);
        return Done{};
    }

  private:
    void readTextures() {
        for (const std::string& name : file_.textures) {
            model_.materials.emplace_back();
            model_.materialNames.push_back(name);
            auto bytes = intake_.readBeside(path_, name);
            auto decoded = bytes ? readPicture(std::move(*bytes), name, intake_) : Result<Picture>(bytes.failure());
            if (!decoded) {
                blemishes_.note("texture left out: " + decoded.failure().diagnostics.front().message);
                continue;
            }
            model_.materials.back().baseColorImage = int(model_.images.size());
            model_.images.push_back(std::move(*decoded));
        }
    }

    Status read(const PlyElement& element) {
        if (element.properties.empty()) return Done{};
        if (Status whole = told(file_.expect(element)); !whole) return whole;
        if (element.name == "vertex") return readVertices(element);
        if (element.name == "face") return readFaces(element);
        if (element.name == "tristrips") return readStrips(element);
        for (uint64_t i = 0; i < element.count; ++i)
            if (Status row = readRow(element, i, {}, nullptr); !row) return row;
        return Done{};
    }

    // At the place that the file has reached: a line of a text, a byte of a binary.
    Failure here(std::string message) const {
        if (file_.line() > 0) return Failure(Diagnostic{path_, file_.line(), 0, {}, std::move(message)});
        return Failure(path_, file_.here(message));
    }
    Status told(std::string wrong) const {
        if (wrong.empty()) return Done{};
        return here(std::move(wrong));
    }
    Status readRow(const PlyElement& element, uint64_t number, std::span<const int> slots, double* values) {
        return told(file_.readRow(element, number, slots, values));
    }

    Status readVertices(const PlyElement& element) {
        if (element.count > kMaxVertices) return Failure(path_, "more than 67 million vertices");
        std::vector<int> slots(element.properties.size(), -1);
        std::array<PlyType, kSlots> types{};
        uint32_t has = 0;
        for (size_t slot = 0; slot < kSlots; ++slot) {
            const int at = element.find(kVertexNames[slot]);
            if (at < 0 || element.properties[size_t(at)].list) continue;
            slots[size_t(at)] = int(slot);
            types[slot] = element.properties[size_t(at)].type;
            has |= 1u << slot;
        }
        const auto hasAll = [&](uint32_t mask) { return (has & mask) == mask; };
        if (!hasAll(7u)) return Failure(path_, "vertices have no x, y and z");
        const bool normals = hasAll(7u << kNormal), uvs = hasAll(3u << kUv), colours = hasAll(7u << kColour);
        for (uint64_t i = 0; i < element.count; ++i) {
            double v[kSlots] = {};
            v[kAlpha] = 1;
            if (Status row = readRow(element, i, slots, v); !row) return row;
            positions_.push_back({v[0], v[1], v[2]});
            if (normals) model_.normals.push_back(direction({float(v[3]), float(v[4]), float(v[5])}));
            if (uvs) model_.uvs.push_back(uv(v[6], v[7]));
            if (!colours) continue;
            for (size_t k = kColour; k < kAlpha; ++k) v[k] = shareOf(v[k], types[k]);
            if (has >> kAlpha & 1u) v[kAlpha] = shareOf(v[kAlpha], types[kAlpha]);
            model_.colours.push_back({float(v[8]), float(v[9]), float(v[10]), float(v[11])});
        }
        return Done{};
    }

    glm::vec3 direction(glm::vec3 n) {
        float length = glm::length(n);
        if (!std::isfinite(length))
            blemishes_.note("a normal that is not a number: it is made from the faces", file_.line());
        return length > 0 && std::isfinite(length) ? n / length : glm::vec3(0);
    }

    // As in OBJ, v counts upwards.
    glm::vec2 uv(double u, double v) {
        if (std::isfinite(float(u)) && std::isfinite(float(v))) return {float(u), 1 - float(v)};
        blemishes_.note("a texture coordinate that is not a number: its vertex has none", file_.line());
        return glm::vec2(kNotGiven);
    }

    Status takeVertex(const char* what, uint64_t number, double index, uint32_t& out) {
        const std::string place = what + (" " + std::to_string(number) + ": vertex ");
        if (!(index >= 0) || index >= double(positions_.size()) || index != std::floor(index))
            return here(place + std::to_string((long long)(std::abs(index) < 1e15 ? index : -1)) +
                        " does not exist: the file has " + std::to_string(positions_.size()));
        out = uint32_t(index);
        if (!isPlace(positions_[out]))
            return here(place + std::to_string(out) + " has a position that is not a number of sane size");
        return Done{};
    }

    Status readFaces(const PlyElement& element) {
        const int corners = element.find({"vertex_indices", "vertex_index"}), uvs = element.find({"texcoord"});
        const int texture = element.find({"texnumber"});
        std::vector<int> slots(element.properties.size(), -1);
        PlyType types[3] = {};
        int colours = 0;
        for (int k = 0; k < 3; ++k)
            if (const int at = element.find(kVertexNames[kColour + size_t(k)]); at >= 0)
                slots[size_t(at)] = k, types[k] = element.properties[size_t(at)].type, ++colours;
        if (texture >= 0) slots[size_t(texture)] = 3;
        if (corners < 0 || !element.properties[size_t(corners)].list) return here("faces have no vertex_indices");
        const bool hasUvs = uvs >= 0 && element.properties[size_t(uvs)].list;
        for (uint64_t i = 0; i < element.count; ++i) {
            double values[4] = {};
            if (Status row = readRow(element, i, slots, values); !row) return row;
            for (int k = 0; k < 3; ++k) values[k] = shareOf(values[k], types[k]);
            uint32_t colour = colours == 3 ? packed(values) : 0;
            Status done = face("face", i, file_.lists[size_t(corners)], hasUvs ? &file_.lists[size_t(uvs)] : nullptr,
                               colour, materialOf(values[3]));
            if (!done) return done;
        }
        return Done{};
    }

    static uint32_t packed(const double* share) {
        uint32_t out = 0xFF000000u;
        for (uint32_t k = 0; k < 3; ++k) {
            // Of faces, too, some files have floats from 0 to 255.
            const double value = share[k] > 1 ? share[k] : share[k] * 255;
            out |= uint32_t(std::clamp(std::isfinite(value) ? value : 255.0, 0.0, 255.0) + 0.5) << (8 * k);
        }
        return out;
    }

    uint32_t materialOf(double number) {
        if (number >= 0 && number < double(std::max<size_t>(model_.materials.size(), 1))) return uint32_t(number);
        if (number >= 0) blemishes_.note("a face with a texture that no comment names", file_.line());
        return 0;
    }

    // what: the element's name, for messages.
    Status face(const char* what, uint64_t number, std::span<const double> corners, const std::vector<double>* uvs,
                uint32_t colour, uint32_t material) {
        polygon_.clear();
        const bool whole = uvs && uvs->size() == corners.size() * 2;
        if (uvs && !whole && !uvs->empty())
            blemishes_.note("a face without two texture coordinates a corner", file_.line());
        for (size_t k = 0; k < corners.size(); ++k) {
            uint32_t vertex = 0;
            Status done = takeVertex(what, number, corners[k], vertex);
            if (!done) return done;
            if (splits_) {
                Corner corner{vertex, -1, -1, colour};
                if (whole) corner.uv = std::bit_cast<int64_t>(uv((*uvs)[2 * k], (*uvs)[2 * k + 1]));
                vertex = vertices_.try_emplace(corner, uint32_t(vertices_.size())).first->second;
            }
            polygon_.push_back(vertex);
        }
        if (polygon_.size() < 3)
            blemishes_.note("a face of fewer than 3 corners left out", file_.line());
        else
            polygons_.add(polygon_, material);
        return Done{};
    }

    // Each triangle of a strip shares two corners with the one before it, and turns the other way; -1 begins anew.
    Status readStrips(const PlyElement& element) {
        const int corners = element.find({"vertex_indices", "vertex_index"});
        if (corners < 0 || !element.properties[size_t(corners)].list) return here("strips have no vertex_indices");
        for (uint64_t i = 0; i < element.count; ++i) {
            if (Status row = readRow(element, i, {}, nullptr); !row) return row;
            const std::vector<double>& strip = file_.lists[size_t(corners)];
            for (size_t k = 0, first = 0; k < strip.size(); ++k) {
                if (strip[k] < 0 || strip[k] == kUnsignedRestart) first = k + 1;
                if (k < first + 2) continue;
                double a = strip[k - 2], b = strip[k - 1], c = strip[k];
                if (a == b || b == c || c == a) continue;  // leads on to another place
                if ((k - first) % 2 != 0) std::swap(a, b);
                const double triangle[3] = {a, b, c};
                Status done = face("tristrips", i, triangle, nullptr, 0, 0);
                if (!done) return done;
            }
        }
        return Done{};
    }

    // Corners that differ in UV or colour are vertices of their own.
    void takeSplitVertices() {
        std::vector<glm::vec3> normals(model_.normals.empty() ? 0 : vertices_.size());
        std::vector<glm::vec2> uvs(vertices_.size(), glm::vec2(kNotGiven));
        std::vector<glm::vec4> colours(vertices_.size(), glm::vec4(kNotGiven));
        places_.resize(vertices_.size());
        bool anyUvs = false;
        for (const auto& [corner, vertex] : vertices_) {
            const size_t from = size_t(corner.position);
            places_[vertex] = positions_[from];
            if (!normals.empty()) normals[vertex] = model_.normals[from];
            if (!model_.uvs.empty()) uvs[vertex] = model_.uvs[from];
            if (corner.uv != -1) uvs[vertex] = std::bit_cast<glm::vec2>(corner.uv);
            anyUvs = anyUvs || !std::isnan(uvs[vertex].x);
            if (!model_.colours.empty()) colours[vertex] = model_.colours[from];
            for (int k = 0; corner.variant != 0 && k < 4; ++k)
                colours[vertex][k] = float(corner.variant >> (8 * k) & 255u) / 255;
        }
        model_.normals = std::move(normals);
        model_.uvs = anyUvs ? std::move(uvs) : std::vector<glm::vec2>();
        model_.colours = std::move(colours);
    }

    const std::string& path_;
    const ImportOptions& options_;
    Intake& intake_;
    PlyFile file_;
    Model& model_;
    Blemishes blemishes_;
    std::vector<glm::dvec3> positions_;  // of the file's vertices
    std::vector<uint32_t> polygon_;
    Polygons polygons_;
    bool splits_ = false;  // corners have values of their own
    CornerVertices vertices_;
    std::vector<glm::dvec3> places_;  // of the model's vertices, where corners are split
};

}  // namespace

Status importPly(const std::string& path, Bytes file, const ImportOptions& options, Intake& intake, Model& model) {
    return PlyReader(path, file, options, intake, model).run();
}

}  // namespace espalier::import
