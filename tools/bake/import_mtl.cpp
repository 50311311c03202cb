// In: lines that name libraries and materials, and the .mtl files beside the model. Out: materials as far as they are
// drawn. Whatever is missing or not understood becomes a warning: a model without its materials can still be baked.
#include "tools/bake/import_mtl.hpp"

#include <algorithm>

#include "tools/bake/import_kind.hpp"
#include "tools/bake/import_mtl_picture.hpp"
#include "tools/bake/import_text.hpp"

namespace espalier::import {
namespace {

constexpr size_t kMostReadings = 8;  // of a name
constexpr size_t kMostPictures = 4096;
constexpr double kMostEmission = 1000;  // of a light's colour

std::string_view withoutQuotes(std::string_view text) {
    const bool quoted = text.size() > 1 && text.front() == '"' && text.back() == '"';
    return quoted ? trimmed(text.substr(1, text.size() - 2)) : text;
}

// What a line may mean by a name: all of it, blanks and # included; or what stands before a comment; without quotes.
std::vector<std::string> readingsOf(std::string_view text) {
    std::vector<std::string> out;
    const auto add = [&](std::string_view reading) {
        reading = withoutQuotes(trimmed(reading));
        if (!reading.empty() && std::ranges::find(out, reading) == out.end()) out.emplace_back(reading);
    };
    add(text);
    // Few comments hold several.
    for (size_t at = text.rfind('#'); at != text.npos && at > 0 && out.size() < kMostReadings;
         at = text.rfind('#', at - 1))
        if (isBlank(text[at - 1])) add(text.substr(0, at));
    return out;
}

// How a texture's statement goes on after its keyword.
struct TextureStatement {
    UvScaling scaling;
    float bump = 1;
    bool clamped = false;
    std::string_view name;
    std::string_view unknown;  // from an option on that we don't know: it may be a name
};

struct TextureOption {
    std::string_view name;
    int values;  // at most
    bool numbers;
};
constexpr TextureOption kTextureOptions[] = {{"-s", 3, true},       {"-o", 3, true},          {"-t", 3, true},
                                             {"-mm", 2, true},      {"-bm", 1, true},         {"-boost", 1, true},
                                             {"-texres", 1, false}, {"-clamp", 1, false},     {"-blendu", 1, false},
                                             {"-blendv", 1, false}, {"-imfchan", 1, false},   {"-cc", 1, false},
                                             {"-type", 1, false},   {"-colorspace", 1, false}};

// From UVs that are scaled in one way, v downwards, to those that are scaled in another.
TextureMap relativeTo(const UvScaling& drawn, const UvScaling& wanted) {
    if (drawn == wanted || drawn.scale.x == 0 || drawn.scale.y == 0) return {};
    TextureMap map;
    map.scale = wanted.scale / drawn.scale;
    map.offset = wanted.offset - drawn.offset * map.scale;
    map.offset.y = 1 - map.scale.y - map.offset.y;
    return map;
}

TextureStatement readTexture(std::string_view line) {
    TextureStatement out;
    for (;;) {
        std::string_view rest = trimmed(line), word = nextWord(rest);
        if (word.size() < 2 || word.front() != '-') break;
        const auto* option = std::ranges::find(kTextureOptions, smallLetters(word), &TextureOption::name);
        const bool known = option != std::end(kTextureOptions);
        if (!known && out.unknown.empty()) out.unknown = trimmed(line);
        double values[3] = {};
        int count = 0;
        std::string_view stated = rest;
        // The last word is the file's, be it a number.
        for (std::string_view ahead = rest; count < (known ? option->values : 1); ++count) {
            const std::string_view value = nextWord(ahead);
            if (trimmed(ahead).empty()) break;
            if (known && option->numbers && !(toNumber(value, values[count]) && std::isfinite(values[count]))) break;
            rest = ahead;
        }
        if (word == "-s" && count > 0) out.scaling.scale = {values[0], count > 1 ? values[1] : 1};
        if (word == "-o" && count > 0) out.scaling.offset = {values[0], count > 1 ? values[1] : 0};
        if (word == "-bm" && count > 0) out.bump = float(values[0]);
        if (word == "-clamp" && count > 0) out.clamped = smallLetters(nextWord(stated)) == "on";
        line = rest;
    }
    out.name = trimmed(line);
    return out;
}

}  // namespace

// One .mtl file.
class MaterialLibrary::File {
  public:
    File(MaterialLibrary& to, std::string name)
        : to_(to), name_(std::move(name)), folder_(name_.substr(0, name_.find_last_of("/\\") + 1)) {}

    void read(int line) {
        auto text = to_.intake_.readBeside(to_.path_, name_);
        if (!text) return to_.warn(line, "materials left out: " + text.failure().diagnostics.front().message);
        std::string_view all(reinterpret_cast<const char*>(text->data()), text->size());
        if (const FileKind* kind = all.empty() ? nullptr : kindOf(*text))
            return to_.warn(line, "materials left out: '" + name_ + "' is " + kind->name);
        (void)eachLine(all, [&](std::string_view statement, int number) -> Status {
            read(statement, number);
            return Done{};
        });
        finish();
    }

  private:
    // What is decided when all statements of a material are known.
    struct Stated {
        bool dissolved = false;   // `d`
        double transparency = 0;  // `Tr`
        bool normals = false;     // by `norm`, not by `bump`
        bool pictured = false;    // by any picture; all are wrapped as the first is
        int cutOut = -1;          // the picture of map_d
        int cutOutLine = 0;
        std::optional<UvScaling> ofColour, ofCutOut, ofNormals, ofEmission;
    };

    void warn(int line, std::string message) {
        to_.model_.warnings.push_back({name_, line, 0, {}, std::move(message), true});
    }

    void begin(std::string_view name) {
        finish();
        current_ = uint32_t(to_.model_.materials.size());
        to_.model_.materials.emplace_back();
        to_.scalings_.emplace_back();
        const std::vector<std::string> readings = readingsOf(name);
        to_.model_.materialNames.push_back(readings.empty() ? "" : readings.front());
        for (size_t i = 0; i < readings.size(); ++i) {
            if (i == 0)
                to_.names_[readings[i]] = current_;
            else
                to_.names_.emplace(readings[i], current_);
        }
    }

    Material& material() { return to_.model_.materials[current_]; }

    void read(std::string_view line, int number) {
        const std::string key = smallLetters(nextWord(line));
        if (key == "newmtl") return begin(trimmed(line));
        if (current_ == 0) return;
        double value[3] = {1, 1, 1};
        size_t count = 0;
        for (std::string_view rest = line; count < 3 && toNumber(nextWord(rest), value[count]);) ++count;
        const bool one = count >= 1 && std::isfinite(value[0]);
        if (key == "kd" && (count == 1 || count == 3))
            for (int i = 0; i < 3; ++i) {
                const double channel = value[count == 1 ? 0 : i];
                material().baseColor[i] = float(std::isfinite(channel) ? channel : 1);
            }
        if (key == "d" && one) material().baseColor.a = float(value[0]), stated_.dissolved = true;
        if (key == "tr" && one) stated_.transparency = value[0];
        if (key == "pr" && one) material().roughness = float(value[0]);
        // The lobe of Blinn and Phong with this exponent is about as wide as that of this roughness.
        if (key == "ns" && one && value[0] >= 0) material().roughness = float(std::sqrt(2 / (value[0] + 2)));
        if (key == "ke" && (count == 1 || count == 3))
            for (int i = 0; i < 3; ++i) {
                const double channel = value[count == 1 ? 0 : i];
                material().emissive[i] = float(std::clamp(std::isfinite(channel) ? channel : 0, 0.0, kMostEmission));
            }
        if (key == "map_kd") material().baseColorImage = picture(line, number, stated_.ofColour).index;
        if (key == "map_ke") material().emissiveImage = picture(line, number, stated_.ofEmission).index;
        if (key == "map_d") stated_.cutOut = picture(line, number, stated_.ofCutOut).index, stated_.cutOutLine = number;
        if (key == "norm" || key == "map_norm" || key == "map_kn") readNormals(line, number);
        if (key == "bump" || key == "map_bump") readBump(line, number);
    }

    struct Found {
        int index = -1;
        float bump = 1;
    };
    Found picture(std::string_view line, int number, std::optional<UvScaling>& scaling) {
        const TextureStatement statement = readTexture(line);
        scaling = statement.scaling;
        if (statement.clamped && !stated_.pictured) material().wrapU = material().wrapV = Wrap::clamp;
        stated_.pictured = true;
        std::vector<std::string> names = readingsOf(statement.name);
        for (std::string& name : readingsOf(statement.unknown)) names.push_back(std::move(name));
        return {to_.picture(folder_, names, [&](std::string message) { warn(number, std::move(message)); }),
                statement.bump};
    }

    void readNormals(std::string_view line, int number) {
        const Found found = picture(line, number, stated_.ofNormals);
        material().normalImage = found.index;
        material().normalScale = found.bump;
        stated_.normals = true;
    }

    // By the specification a map of heights, but most programs write normal maps here.
    void readBump(std::string_view line, int number) {
        if (stated_.normals) return;
        const Found found = picture(line, number, stated_.ofNormals);
        if (found.index < 0) return;
        if (!holdsNormals(to_.model_.images[size_t(found.index)]))
            return warn(number, "a bump map of heights isn't drawn: only maps of normals are");
        material().normalImage = found.index;
        material().normalScale = found.bump;
    }

    void finish() {
        if (current_ != 0) {
            Material& m = material();
            // A material of full transparency would be none at all: where `Tr` is 1, its writer meant `d`.
            if (!stated_.dissolved && stated_.transparency > 0 && stated_.transparency < 1)
                m.baseColor.a = float(1 - stated_.transparency);
            m.bare = m.baseColor.a < 1;
            if (stated_.cutOut >= 0) cutOut(m);
            // A picture that emits without a colour emits as it is.
            if (m.emissiveImage >= 0 && m.emissive == glm::vec3(0)) m.emissive = glm::vec3(1);
            scaleUvs(m);
        }
        stated_ = {};
    }

    // Vertices' UVs are those of the colours; other pictures are laid on relative to these.
    void scaleUvs(Material& m) {
        const UvScaling drawn =
            stated_.ofColour.value_or(stated_.ofNormals.value_or(stated_.ofEmission.value_or(UvScaling())));
        to_.scalings_[current_] = drawn;
        if (stated_.ofNormals) m.normalMap = relativeTo(drawn, *stated_.ofNormals);
        if (stated_.ofEmission) m.emissiveMap = relativeTo(drawn, *stated_.ofEmission);
        if (stated_.ofCutOut.value_or(drawn) != drawn)
            warn(stated_.cutOutLine, "-s and -o differ from those of the material's colours, which are taken");
    }

    void cutOut(Material& m) {
        m.alphaCutoff = 0.5f;
        if (m.baseColorImage == stated_.cutOut) return;  // by its own alpha
        std::vector<Picture>& images = to_.model_.images;
        const Picture* colour = m.baseColorImage < 0 ? nullptr : &images[size_t(m.baseColorImage)];
        auto cut = withCutOut(colour, images[size_t(stated_.cutOut)], to_.intake_);
        if (!cut) return warn(stated_.cutOutLine, "cut-out left out: it takes absurdly much for files of this size");
        m.baseColorImage = int(images.size());
        images.push_back(std::move(*cut));
    }

    MaterialLibrary& to_;
    const std::string name_, folder_;
    uint32_t current_ = 0;  // the material of the last newmtl; 0: none yet
    Stated stated_;
};

MaterialLibrary::MaterialLibrary(const std::string& path, Intake& intake, Model& model)
    : path_(path), intake_(intake), model_(model) {
    model_.materials.emplace_back();
    model_.materialNames.emplace_back();
    scalings_.emplace_back();
}

void MaterialLibrary::warn(int line, std::string message) {
    model_.warnings.push_back({path_, line, 0, {}, std::move(message), true});
}

// A name may hold blanks, and a line several names: all of it where there is such a file; else names between quotes,
// and words up to one that ends as a library does.
std::vector<std::string> MaterialLibrary::filesOf(std::string_view names) {
    for (const std::string& name : readingsOf(names))
        if (intake_.isBeside(path_, name)) return {name};
    std::vector<std::string> files;
    for (std::string_view rest = trimmed(names), begin = rest; !rest.empty(); rest = trimmed(rest)) {
        const size_t close = rest.find('"', 1);
        if (rest.data() == begin.data() && rest.front() == '"' && close != rest.npos) {
            files.emplace_back(rest.substr(1, close - 1));
            begin = rest = trimmed(rest.substr(close + 1));
            continue;
        }
        const std::string_view word = nextWord(rest);
        if (word.data() == begin.data() && word.front() == '#') break;
        if (!smallLetters(word).ends_with(".mtl") && !trimmed(rest).empty()) continue;
        files.emplace_back(begin.substr(0, size_t(word.data() + word.size() - begin.data())));
        begin = trimmed(rest);
    }
    return files;
}

void MaterialLibrary::readLibraries(std::string_view names, int line) {
    for (const std::string& name : filesOf(names)) File(*this, name).read(line);
}

uint32_t MaterialLibrary::find(std::string_view name, int line) {
    const std::vector<std::string> readings = readingsOf(name);
    for (const std::string& reading : readings)
        if (auto it = names_.find(reading); it != names_.end()) return it->second;
    if (!readings.empty() && unknown_.insert(readings.front()).second)
        warn(line, "material '" + readings.front().substr(0, 80) + "' is not defined");
    return 0;
}

bool MaterialLibrary::scalesAny() const {
    return std::ranges::any_of(scalings_, [](const UvScaling& s) { return s != UvScaling(); });
}

// Beside the library, or else beside the model.
std::string MaterialLibrary::placeOf(const std::string& folder, const std::vector<std::string>& names) {
    for (const std::string& name : names)
        for (const std::string& place : {folder + name, name})
            if (intake_.isBeside(path_, place)) return place;
    return folder + names.front();
}

int MaterialLibrary::picture(const std::string& folder, const std::vector<std::string>& names,
                             const std::function<void(std::string)>& warn) {
    if (names.empty()) return -1;
    const auto [known, isNew] = pictures_.try_emplace(folder + names.front(), -1);
    int& index = known->second;
    if (!isNew) return index;
    if (pictures_.size() > kMostPictures) {
        if (pictures_.size() == kMostPictures + 1) warn("more than 4,096 pictures: the others are left out");
        return index;
    }
    const std::string file = placeOf(folder, names);
    auto bytes = intake_.readBeside(path_, file);
    auto decoded = bytes ? readPicture(std::move(*bytes), file, intake_) : Result<Picture>(bytes.failure());
    if (!decoded) {
        warn("texture left out: " + decoded.failure().diagnostics.front().message);
        return index;
    }
    index = int(model_.images.size());
    model_.images.push_back(std::move(*decoded));
    return index;
}

}  // namespace espalier::import
