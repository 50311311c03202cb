// In: an OBJ file's text, and the .mtl and pictures beside it. Out: triangles, a vertex for each combination of
// position, UV and normal that a face's corner names. Materials that are missing become warnings; a line that can't be
// read is an error that names it. v of UVs is turned over: OBJ counts it upwards, glTF (and we) downwards.
#include <limits>
#include <map>
#include <unordered_map>

#include "tools/bake/import.hpp"
#include "tools/bake/import_text.hpp"

namespace espalier::import {
namespace {

// One corner: indices from 0; -1: none.
struct Corner {
    int64_t position = -1, uv = -1, normal = -1;
    bool operator==(const Corner&) const = default;
};
struct CornerHash {
    size_t operator()(const Corner& c) const {
        return size_t((uint64_t(c.position) * 0x9E3779B97F4A7C15ull ^ uint64_t(c.uv)) * 0xD1B54A32D192ED03ull ^
                      uint64_t(c.normal) * 0x94D049BB133111EBull);
    }
};

// Calls statement(line, number, text) for every line that holds something; a backslash at its end joins the next one.
template <class Statement>
Status eachLine(std::string_view text, Statement&& statement) {
    std::string joined;
    int number = 0, first = 0;
    while (!text.empty()) {
        size_t end = text.find('\n');
        std::string_view line = text.substr(0, end);
        text.remove_prefix(end == text.npos ? text.size() : end + 1);
        ++number;
        if (joined.empty()) first = number;
        line = trimmed(line.substr(0, line.find('#')));
        bool more = !line.empty() && line.back() == '\\';
        if (more) line.remove_suffix(1);
        if (more || !joined.empty()) joined.append(line).push_back(' ');
        if (more) continue;
        std::string_view whole = joined.empty() ? line : std::string_view(joined);
        if (!trimmed(whole).empty()) {
            Status done = statement(trimmed(whole), first);
            if (!done) return done;
        }
        joined.clear();
    }
    return Done{};
}

Failure failure(const std::string& path, int line, std::string message) {
    return Failure(Diagnostic{path, line, 0, {}, std::move(message)});
}

// Materials of one .mtl file, as far as they are drawn.
class MaterialFile {
  public:
    MaterialFile(const std::string& path, const std::string& name, Intake& intake, Model& model,
                 std::map<std::string, uint32_t, std::less<>>& names)
        : path_(path), name_(name), intake_(intake), model_(model), names_(names) {}

    void read() {
        auto text = intake_.readBeside(path_, name_);
        if (!text) return warn(0, "materials left out: " + text.failure().diagnostics.front().message);
        std::string_view all(reinterpret_cast<const char*>(text->data()), text->size());
        Status done = eachLine(all, [&](std::string_view line, int number) -> Status {
            statement(line, number);
            return Done{};
        });
        (void)done;  // materials have no mistakes that would stop a bake
    }

  private:
    void warn(int line, std::string message) {
        model_.warnings.push_back({line > 0 ? name_ : path_, line, 0, {}, std::move(message), true});
    }

    void statement(std::string_view line, int number) {
        std::string_view key = nextWord(line);
        if (key == "newmtl") {
            names_[std::string(trimmed(line))] = uint32_t(model_.materials.size());
            model_.materials.emplace_back();
            model_.materialNames.emplace_back(trimmed(line));
            material_ = &model_.materials.back();
            return;
        }
        if (!material_) return;
        double value[3] = {1, 1, 1};
        size_t count = 0;
        for (std::string_view rest = line; count < 3 && toNumber(nextWord(rest), value[count]);) ++count;
        bool number1 = count >= 1 && std::isfinite(value[0]);
        if (key == "Kd" && count == 3)
            for (int i = 0; i < 3; ++i) material_->baseColor[i] = float(std::isfinite(value[i]) ? value[i] : 1);
        if (key == "d" && number1) material_->baseColor.a = float(value[0]), material_->bare = value[0] < 1;
        if (key == "Pr" && number1) material_->roughness = float(value[0]);
        // The lobe of Blinn and Phong with this exponent is about as wide as that of this roughness.
        if (key == "Ns" && number1 && value[0] >= 0) material_->roughness = float(std::sqrt(2 / (value[0] + 2)));
        if (key == "map_Kd") material_->baseColorImage = picture(line, number);
        if (key == "map_d" && material_->baseColorImage >= 0) material_->alphaCutoff = 0.5f;
        if (key == "norm") material_->normalImage = picture(line, number);
    }

    // The file's name after options such as "-s 1 1 1"; it may hold blanks.
    int picture(std::string_view line, int number) {
        for (;;) {
            std::string_view rest = line, option = nextWord(rest);
            if (option.size() < 2 || option.front() != '-') break;
            bool several = option == "-o" || option == "-s" || option == "-t" || option == "-mm";
            double ignored;
            if (!several) nextWord(rest);
            for (std::string_view ahead = rest; several && toNumber(nextWord(ahead), ignored);) rest = ahead;
            line = rest;
        }
        std::string name(trimmed(line));
        for (char& c : name) c = c == '\\' ? '/' : c;
        auto known = pictures_.find(name);
        if (known != pictures_.end()) return known->second;
        int& index = pictures_[name] = -1;
        auto bytes = intake_.readBeside(path_, name);
        auto decoded = bytes ? readPicture(std::move(*bytes), name, intake_) : Result<Picture>(bytes.failure());
        if (!decoded) {
            warn(number, "texture left out: " + decoded.failure().diagnostics.front().message);
        } else {
            index = int(model_.images.size());
            model_.images.push_back(std::move(*decoded));
        }
        return index;
    }

    const std::string& path_;
    const std::string name_;
    Intake& intake_;
    Model& model_;
    std::map<std::string, uint32_t, std::less<>>& names_;
    std::map<std::string, int> pictures_;
    Material* material_ = nullptr;  // that of the last newmtl
};

class ObjReader {
  public:
    ObjReader(const std::string& path, Intake& intake, Model& model) : path_(path), intake_(intake), model_(model) {
        model_.materials.emplace_back();
        model_.materialNames.emplace_back();
    }

    Status run(std::string_view text) {
        Status done = eachLine(text, [&](std::string_view line, int number) { return statement(line, number); });
        if (!done) return done;
        if (skipped_ > 0) warn(0, std::to_string(skipped_) + " points, lines or curved pieces left out");
        if (model_.indices.empty()) return Failure(path_, "the file holds no faces");
        if (!anyUvs_) model_.uvs.clear();
        if (!allNormals_) model_.normals.clear();
        return Done{};
    }

  private:
    void warn(int line, std::string message) {
        model_.warnings.push_back({path_, line, 0, {}, std::move(message), true});
    }

    Status statement(std::string_view line, int number) {
        std::string_view key = nextWord(line);
        if (key == "v") return numbers(line, number, 3, 3, positions_);
        if (key == "vn") return numbers(line, number, 3, 3, normals_);
        if (key == "vt") return numbers(line, number, 1, 2, uvs_);
        if (key == "f") return face(line, number);
        if (key == "usemtl") useMaterial(trimmed(line), number);
        if (key == "mtllib") MaterialFile(path_, std::string(trimmed(line)), intake_, model_, names_).read();
        if (key == "l" || key == "p" || key == "curv" || key == "surf") ++skipped_;
        // Groups, smoothing and what programs add of their own change no triangle.
        return Done{};
    }

    // At least `least` numbers, of which `kept` are kept; those that are missing are 0.
    Status numbers(std::string_view line, int number, int least, int kept, std::vector<glm::vec3>& into) {
        glm::vec3 out(0);
        for (int i = 0; i < kept; ++i) {
            std::string_view word = nextWord(line);
            if (word.empty() && i >= least) break;
            double value = 0;
            if (word.empty()) return failure(path_, number, "fewer than " + std::to_string(least) + " numbers");
            if (!toNumber(word, value) || !std::isfinite(float(value)))
                return failure(path_, number, "'" + std::string(word.substr(0, 40)) + "' is not a number");
            out[i] = float(value);
        }
        into.push_back(out);
        return Done{};
    }

    // Takes one index of "7/3/-1" off a corner. Negative ones count back from the last that has been defined.
    Status index(std::string_view& corner, size_t count, const char* what, int number, int64_t& out) {
        size_t end = std::min(corner.find('/'), corner.size());
        std::string_view word = corner.substr(0, end);
        corner.remove_prefix(std::min(end + 1, corner.size()));
        if (word.empty()) return Done{};
        long long value = 0;
        if (!toInteger(word, value))
            return failure(path_, number, "'" + std::string(word.substr(0, 40)) + "' is not an index");
        long long at = value < 0 ? (long long)count + value : value - 1;
        if (value == 0 || at < 0 || at >= (long long)count)
            return failure(path_, number,
                           std::string(what) + " " + std::to_string(value) +
                               " does not exist: " + std::to_string(count) + " defined so far");
        out = at;
        return Done{};
    }

    Status face(std::string_view line, int number) {
        polygon_.clear();
        for (std::string_view word = nextWord(line); !word.empty(); word = nextWord(line)) {
            Corner corner;
            for (auto [count, what, out] : {std::tuple(positions_.size(), "vertex", &corner.position),
                                            std::tuple(uvs_.size(), "texture coordinate", &corner.uv),
                                            std::tuple(normals_.size(), "normal", &corner.normal)}) {
                Status done = index(word, count, what, number, *out);
                if (!done) return done;
            }
            if (corner.position < 0) return failure(path_, number, "a corner without a vertex");
            polygon_.push_back(vertexOf(corner));
        }
        if (polygon_.size() < 3) return failure(path_, number, "a face of fewer than 3 corners");
        if (model_.positions.size() > kMaxVertices) return Failure(path_, "more than 67 million vertices");
        triangulate(model_.positions, polygon_, model_.indices);
        model_.triangleMaterial.resize(model_.indices.size() / 3, material_);
        return Done{};
    }

    uint32_t vertexOf(const Corner& corner) {
        auto [it, isNew] = vertices_.try_emplace(corner, uint32_t(model_.positions.size()));
        if (!isNew) return it->second;
        model_.positions.push_back(positions_[size_t(corner.position)]);
        float none = std::numeric_limits<float>::quiet_NaN();
        glm::vec2 uv(none);
        if (corner.uv >= 0) uv = {uvs_[size_t(corner.uv)].x, 1 - uvs_[size_t(corner.uv)].y}, anyUvs_ = true;
        model_.uvs.push_back(uv);
        glm::vec3 normal = corner.normal < 0 ? glm::vec3(0) : normals_[size_t(corner.normal)];
        float length = glm::length(normal);
        if (!(length > 0) || !std::isfinite(length)) allNormals_ = false, normal = glm::vec3(0), length = 1;
        model_.normals.push_back(normal / length);
        return it->second;
    }

    void useMaterial(std::string_view name, int number) {
        auto it = names_.find(name);
        material_ = it == names_.end() ? 0 : it->second;
        if (it != names_.end()) return;
        names_.emplace(std::string(name), 0);
        warn(number, "material '" + std::string(name.substr(0, 80)) + "' is not defined");
    }

    const std::string& path_;
    Intake& intake_;
    Model& model_;
    std::vector<glm::vec3> positions_, normals_, uvs_;
    std::unordered_map<Corner, uint32_t, CornerHash> vertices_;
    std::map<std::string, uint32_t, std::less<>> names_;  // materials by name
    std::vector<uint32_t> polygon_;
    uint32_t material_ = 0;
    size_t skipped_ = 0;
    bool anyUvs_ = false, allNormals_ = true;
};

}  // namespace

Status importObj(const std::string& path, Bytes file, Intake& intake, Model& model) {
    return ObjReader(path, intake, model)
        .run(std::string_view(reinterpret_cast<const char*>(file.data()), file.size()));
}

}  // namespace espalier::import
