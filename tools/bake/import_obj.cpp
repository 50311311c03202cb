// In: an OBJ file's text, and the .mtl and pictures beside it. Out: triangles, a vertex for each combination of
// position, UV and normal that a face's corner names. What a model can do without is left out with a warning; a face
// that can't be placed is an error that names its line. v of UVs is turned over: OBJ counts it upwards, glTF (and we)
// downwards.

#include "tools/bake/import_mtl.hpp"
#include "tools/bake/import_polygons.hpp"
#include "tools/bake/import_text.hpp"

namespace espalier::import {
namespace {

std::string shown(std::string_view word) {
    return "'" + std::string(word.substr(0, 40)) + "'";
}

class ObjReader {
  public:
    ObjReader(const std::string& path, const ImportOptions& options, Intake& intake, Model& model)
        : path_(path), options_(options), model_(model), materials_(path, intake, model), blemishes_(path) {}

    Status run(std::string_view text) {
        Status done = eachLine(text, [&](std::string_view line, int number) { return statement(line, number); });
        if (!done) return done;
        if (polygons_.empty()) return Failure(path_, "the file holds no faces");
        settle(places_, polygons_.corners(), options_.origin, model_);
        polygons_.fill(model_);
        if (!anyUvs_) model_.uvs.clear();
        if (!anyNormals_) model_.normals.clear();
        if (materials_.scalesAny() && anyUvs_) scaleUvs();
        if (!colours_.empty()) takeColours();
        for (const auto& [vertex, line] : broken_)
            blemishes_.note("a vertex without three numbers of sane size, named by no face", line);
        blemishes_.tell(model_);
        return Done{};
    }

  private:
    Failure failure(int line, std::string message) const {
        return Failure(Diagnostic{path_, line, 0, {}, std::move(message)});
    }

    Status statement(std::string_view line, int number) {
        const std::string_view key = nextWord(line);
        // Names may hold a #; nothing else does.
        if (key == "usemtl") material_ = materials_.find(line, number);
        if (key == "mtllib") materials_.readLibraries(line, number);
        line = withoutComment(line);
        if (key == "v") position(line, number);
        if (key == "vn") normals_.push_back(normal(line, number));
        if (key == "vt") uvs_.push_back(uv(line, number));
        if (key == "f") return face(line, number);
        if (key == "l" || key == "p" || key == "curv" || key == "surf")
            blemishes_.note("points, lines or curved pieces left out", number);
        // Groups, smoothing and what programs add of their own change no triangle.
        return Done{};
    }

    // Up to `most` numbers; returns how many there are before the first word that is none.
    static size_t numbers(std::string_view line, size_t most, double* out) {
        size_t count = 0;
        while (count < most && toNumber(nextWord(line), out[count])) ++count;
        return count;
    }

    void position(std::string_view line, int number) {
        double value[7] = {};
        const size_t count = numbers(line, 7, value);
        const glm::dvec3 p(value[0], value[1], value[2]);
        // No mistake unless a face names it.
        if (count < 3 || !isPlace(p)) broken_.emplace(positions_.size(), number);
        positions_.push_back(p);
        if (count < 6 && colours_.empty()) return;
        // Four numbers are a point and its weight, six and seven a point and its colour.
        colours_.resize(positions_.size(), glm::vec4(kNotGiven));
        if (count >= 6)
            colours_.back() = {float(value[3]), float(value[4]), float(value[5]), count > 6 ? float(value[6]) : 1.0f};
    }

    glm::vec3 normal(std::string_view line, int number) {
        double value[3] = {};
        const bool whole = numbers(line, 3, value) == 3;
        const glm::vec3 n(value[0], value[1], value[2]);
        const float length = glm::length(n);
        if (whole && length > 0 && std::isfinite(length)) return n / length;
        blemishes_.note("a normal that is no direction: it is made from the faces", number);
        return glm::vec3(0);
    }

    glm::vec2 uv(std::string_view line, int number) {
        double value[2] = {};
        const bool any = numbers(line, 2, value) > 0;
        const glm::vec2 out(value[0], value[1]);
        if (any && std::isfinite(out.x) && std::isfinite(out.y)) return out;
        blemishes_.note("a texture coordinate that is no number: its corners have none", number);
        return glm::vec2(kNotGiven);
    }

    // Takes one index of "7/3/-1" off a corner; -1: there is none, -2: it names nothing. Negative ones count back from
    // the last that has been defined.
    static int64_t takeIndex(std::string_view& corner, size_t count, std::string_view& word) {
        const size_t end = std::min(corner.find('/'), corner.size());
        word = corner.substr(0, end);
        corner.remove_prefix(std::min(end + 1, corner.size()));
        if (word.empty()) return -1;
        long long value = 0;
        if (!toInteger(word, value) || value == 0) return -2;
        const long long at = value < 0 ? (long long)count + value : value - 1;
        return at < 0 || at >= (long long)count ? -2 : at;
    }

    // Of a UV or a normal.
    int64_t takeOptional(std::string_view& corner, size_t count, const char* what, int number) {
        std::string_view word;
        const int64_t index = takeIndex(corner, count, word);
        if (index == -2)
            blemishes_.note(std::string("a ") + what + " that does not exist: its corner has none", number);
        return std::max<int64_t>(index, -1);
    }

    Status takePosition(std::string_view& corner, int number, int64_t& out) {
        std::string_view word;
        out = takeIndex(corner, positions_.size(), word);
        if (out == -1) return failure(number, "a corner without a vertex");
        long long value = 0;
        if (out < 0 && !toInteger(word, value)) return failure(number, shown(word) + " is not an index");
        if (out < 0)
            return failure(number, "vertex " + std::to_string(value) +
                                       " does not exist: " + std::to_string(positions_.size()) + " defined so far");
        if (const auto it = broken_.find(size_t(out)); it != broken_.end())
            return failure(it->second, "a vertex without three numbers of sane size, named by the face of line " +
                                           std::to_string(number));
        return Done{};
    }

    Status face(std::string_view line, int number) {
        polygon_.clear();
        for (std::string_view word = nextWord(line); !word.empty(); word = nextWord(line)) {
            Corner corner;
            Status done = takePosition(word, number, corner.position);
            if (!done) return done;
            corner.uv = takeOptional(word, uvs_.size(), "texture coordinate", number);
            corner.normal = takeOptional(word, normals_.size(), "normal", number);
            // Where pictures are laid on unlike, vertices can't be shared.
            if (materials_.scaling(material_) != UvScaling()) corner.variant = material_;
            polygon_.push_back(vertexOf(corner));
        }
        if (places_.size() > kMaxVertices) return Failure(path_, "more than 67 million vertices");
        if (polygon_.size() < 3)
            blemishes_.note("a face of fewer than 3 corners left out", number);
        else
            polygons_.add(polygon_, material_);
        return Done{};
    }

    uint32_t vertexOf(const Corner& corner) {
        auto [it, isNew] = vertices_.try_emplace(corner, uint32_t(places_.size()));
        if (!isNew) return it->second;
        places_.push_back(positions_[size_t(corner.position)]);
        glm::vec2 uv(kNotGiven);
        if (corner.uv >= 0) uv = {uvs_[size_t(corner.uv)].x, 1 - uvs_[size_t(corner.uv)].y}, anyUvs_ = true;
        model_.uvs.push_back(uv);
        glm::vec3 normal(0);
        if (corner.normal >= 0) normal = normals_[size_t(corner.normal)], anyNormals_ = true;
        model_.normals.push_back(normal);
        return it->second;
    }

    void scaleUvs() {
        model_.materialUvs = model_.uvs;
        for (const auto& [corner, vertex] : vertices_)
            model_.materialUvs[vertex] = materials_.scaling(corner.variant)(model_.uvs[vertex]);
    }

    void takeColours() {
        model_.colours.assign(places_.size(), glm::vec4(kNotGiven));
        for (const auto& [corner, vertex] : vertices_)
            if (size_t(corner.position) < colours_.size()) model_.colours[vertex] = colours_[size_t(corner.position)];
        makeColoursLinear(model_);
    }

    const std::string& path_;
    const ImportOptions& options_;
    Model& model_;
    MaterialLibrary materials_;
    Blemishes blemishes_;
    std::vector<glm::dvec3> positions_;
    std::vector<glm::vec3> normals_;
    std::vector<glm::vec2> uvs_;
    std::vector<glm::vec4> colours_;  // of the first positions; empty: none has one
    std::map<size_t, int> broken_;    // positions that are none, by their number, and their lines
    std::vector<glm::dvec3> places_;  // of the model's vertices
    CornerVertices vertices_;
    Polygons polygons_;
    std::vector<uint32_t> polygon_;
    uint32_t material_ = 0;
    bool anyUvs_ = false, anyNormals_ = false;
};

}  // namespace

Status importObj(const std::string& path, Bytes file, const ImportOptions& options, Intake& intake, Model& model) {
    return ObjReader(path, options, intake, model)
        .run(std::string_view(reinterpret_cast<const char*>(file.data()), file.size()));
}

}  // namespace espalier::import
