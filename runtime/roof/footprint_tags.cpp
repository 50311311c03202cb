// In: a feature's tags. Out: the footprint's shape, heights, slopes and look (wiki.openstreetmap.org,
// Simple 3D Buildings), and `edges`, which is ours: [{"edge": 2, "gable": true, "angle": 35}].
#include "runtime/roof/footprint_tags.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>

#include "runtime/roof/footprint_heights.hpp"
#include "runtime/roof/footprint_kinds.hpp"
#include "runtime/roof/footprint_values.hpp"

namespace espalier {

namespace {

using nlohmann::json;

struct NamedShape {
    const char* name;
    RoofShape shape;
    bool exact;  // else the nearest that there is
};
constexpr NamedShape kShapes[] = {
    {"hipped", RoofShape::hip, true},          {"hip", RoofShape::hip, true},
    {"gabled", RoofShape::gable, true},        {"gable", RoofShape::gable, true},
    {"half-hipped", RoofShape::halfHip, true}, {"half_hipped", RoofShape::halfHip, true},
    {"pyramidal", RoofShape::pyramid, true},   {"pyramid", RoofShape::pyramid, true},
    {"skillion", RoofShape::shed, true},       {"lean_to", RoofShape::shed, true},
    {"shed", RoofShape::shed, true},           {"gambrel", RoofShape::gambrel, true},
    {"mansard", RoofShape::mansard, true},     {"flat", RoofShape::flat, true},
    {"dome", RoofShape::pyramid, false},       {"onion", RoofShape::pyramid, false},
    {"cone", RoofShape::pyramid, false},       {"round", RoofShape::gable, false},
    {"saltbox", RoofShape::gable, false},      {"cross_gabled", RoofShape::gable, false},
    {"spherical", RoofShape::pyramid, false},  {"double_saltbox", RoofShape::gable, false},
    {"sawtooth", RoofShape::flat, false},      {"hipped-and-gabled", RoofShape::halfHip, false},
    {"side_hipped", RoofShape::hip, false},    {"gabled_height_moved", RoofShape::gable, false},
    {"butterfly", RoofShape::flat, false},     {"pitched", RoofShape::gable, false},
};

constexpr std::pair<const char*, RoofMaterial> kMaterials[] = {
    {"roof_tiles", RoofMaterial::tiles},
    {"tile", RoofMaterial::tiles},
    {"tiles", RoofMaterial::tiles},
    {"slate", RoofMaterial::slate},
    {"metal", RoofMaterial::metal},
    {"metal_sheet", RoofMaterial::metal},
    {"zinc", RoofMaterial::metal},
    {"tin", RoofMaterial::metal},
    {"copper", RoofMaterial::copper},
    {"thatch", RoofMaterial::thatch},
    {"wood", RoofMaterial::wood},
    {"stone", RoofMaterial::stone},
    {"concrete", RoofMaterial::concrete},
    {"eternit", RoofMaterial::slate},
    {"tar_paper", RoofMaterial::asphalt},
    {"asphalt", RoofMaterial::asphalt},
    {"gravel", RoofMaterial::gravel},
    {"glass", RoofMaterial::glass},
    {"asphalt_shingle", RoofMaterial::asphalt},
    {"grass", RoofMaterial::grass},
};

constexpr std::pair<const char*, uint32_t> kColours[] = {
    {"black", 0x000000}, {"white", 0xffffff},  {"gray", 0x808080},   {"grey", 0x808080},      {"silver", 0xc0c0c0},
    {"red", 0xff0000},   {"maroon", 0x800000}, {"brown", 0xa52a2a},  {"orange", 0xffa500},    {"yellow", 0xffff00},
    {"green", 0x008000}, {"olive", 0x808000},  {"blue", 0x0000ff},   {"navy", 0x000080},      {"teal", 0x008080},
    {"beige", 0xf5f5dc}, {"tan", 0xd2b48c},    {"purple", 0x800080}, {"darkgray", 0xa9a9a9},  {"lightgray", 0xd3d3d3},
    {"lime", 0x00ff00},  {"aqua", 0x00ffff},   {"pink", 0xffc0cb},   {"firebrick", 0xb22222}, {"sienna", 0xa0522d},
};

class Tags {
  public:
    Tags(const FeatureTags& tags, const std::string& file, Footprint& f, std::vector<Diagnostic>& diagnostics)
        : tags_(tags), file_(file), f_(f), diagnostics_(diagnostics) {}

    void apply() {
        f_.part = tags_.says("building:part") || tags_.text("type") == "building_part";
        f_.open = isOpen(tags_);
        if (f_.open) f_.shape = RoofShape::flat;  // what most canopies have
        shape();
        heights();
        direction();
        orientation();
        material();
        colour();
        edges();
    }

  private:
    void warn(const std::string& key, const std::string& what) { note(key, what + ": ignored"); }
    void note(const std::string& key, const std::string& what) {
        diagnostics_.push_back({file_, 0, 0, f_.id, key + " " + what, true});
    }
    std::optional<std::string> text(const char* key) {
        const json* value = tags_.find(key);
        if (!value) return {};
        if (value->is_string()) return value->get_ref<const std::string&>().substr(0, kLongestValue);
        warn(key, "is not a text");
        return {};
    }
    static std::string shown(const std::string& s) { return "'" + s.substr(0, 40) + "'"; }

    using Read = std::optional<double> (*)(const json&);
    bool number(const char* key, Read read, double low, double high, std::optional<double>& out) {
        const json* value = tags_.find(key);
        if (!value) return false;
        std::optional<double> n = read(*value);
        if (!n || !std::isfinite(*n)) {
            warn(key, "is not a number");
            return false;
        }
        if (*n < low || *n > high) {
            char range[96];
            std::snprintf(range, sizeof range, "is %g, not between %g and %g", *n, low, high);
            warn(key, range);
            return false;
        }
        out = n;
        return true;
    }

    // All from the ground; levels below `building:min_level` are counted, though they aren't this part's.
    void heights() {
        number("height", readLength, 0.1, 1000, f_.height);
        number("building:levels", readNumber, 0, 300, f_.levels);
        number("roof:levels", readNumber, 0, 50, f_.roofLevels);
        number("roof:height", readLength, 0, 500, f_.roofHeight);
        if (f_.roofHeight && *f_.roofHeight == 0) f_.roofHeight.reset(), flat();
        std::optional<double> angle = f_.slope ? std::optional(std::atan(*f_.slope)) : std::nullopt;
        if (number("roof:angle", readNumber, 0, 85, angle)) {
            f_.slope = std::tan(glm::radians(*angle));
            if (*angle == 0) f_.slope.reset(), flat();
        }
        std::optional<double> least, storeys;
        if (number("building:min_level", readNumber, 0, 300, storeys)) f_.baseHeight = kStorey * *storeys;
        if (number("min_height", readLength, 0, 1000, least)) f_.baseHeight = *least;
        if (f_.height && *f_.height <= f_.baseHeight) {
            warn("height", "is not above min_height");
            f_.baseHeight = 0;
        }
        countFromFoot(storeys);
        if (f_.open) standOnPosts();
        if (f_.height && f_.roofHeight && *f_.roofHeight > *f_.height - f_.baseHeight + 0.01)
            note("roof:height", "is more than the building's height: the roof takes all of that");
    }
    // Some count a part's storeys from its own foot: what lies wholly below that is meant so.
    void countFromFoot(std::optional<double> foot) {
        constexpr double kDoubt = 0.5;  // storeys
        const double base = foot.value_or(f_.baseHeight / kStorey - kDoubt);
        if (!f_.levels || f_.height || *f_.levels >= base) return;
        note("building:levels", "counts from the ground, and lies below the part's foot: counted from there instead");
        f_.levels = *f_.levels + f_.baseHeight / kStorey;
    }
    // Of a roof on posts the least height is where the roof begins. Posts go down to the ground, those of a part to
    // what it stands on.
    void standOnPosts() {
        const bool sloped = f_.shape != RoofShape::flat && !f_.roofHeight && !f_.slope;
        if (sloped && f_.height && f_.baseHeight > 0) f_.roofHeight = *f_.height - f_.baseHeight;
        if (!f_.part) f_.baseHeight = 0;
    }
    void flat() { f_.shape = RoofShape::flat, f_.shaped = true; }

    void shape() {
        std::optional<std::string> name = text("roof:shape");
        if (!name) return;
        for (const NamedShape& s : kShapes)
            if (lowered(*name) == s.name) {
                f_.shape = s.shape;
                f_.shaped = true;
                if (!s.exact) note("roof:shape", shown(*name) + " is not made: the nearest shape instead");
                return;
            }
        warn("roof:shape", shown(*name) + " is unknown");
    }
    void direction() {
        const json* value = tags_.find("roof:direction");
        if (!value) return;
        const std::optional<double> degrees = readDirection(*value);
        if (!degrees || !std::isfinite(*degrees))
            return warn("roof:direction", "is neither degrees nor a compass point");
        f_.direction = glm::radians(std::fmod(*degrees, 360));
    }
    void orientation() {
        std::optional<std::string> name = text("roof:orientation");
        if (!name) return;
        const std::string word = lowered(*name);
        if (word != "along" && word != "across")
            return warn("roof:orientation", shown(*name) + " is neither along nor across");
        f_.orientation = word == "along" ? RidgeOrientation::along : RidgeOrientation::across;
    }
    void material() {
        std::optional<std::string> name = text("roof:material");
        if (!name) return;
        for (auto [known, material] : kMaterials)
            if (lowered(*name) == known) {
                f_.material = material;
                return;
            }
        warn("roof:material", shown(*name) + " is unknown");
    }
    void colour() {
        std::optional<std::string> name = text("roof:colour");
        if (!name) return;
        std::string c = lowered(*name);
        std::optional<uint32_t> rgb;
        for (auto [known, value] : kColours)
            if (c == known) rgb = value;
        if (c.size() == 4 && c[0] == '#') c = {'#', c[1], c[1], c[2], c[2], c[3], c[3]};
        uint32_t value = 0;
        if (c.size() == 7 && c[0] == '#') {
            auto [end, error] = std::from_chars(c.data() + 1, c.data() + 7, value, 16);
            if (error == std::errc() && end == c.data() + 7) rgb = value;
        }
        if (!rgb) return warn("roof:colour", shown(*name) + " is neither #rrggbb nor a known name");
        f_.colour = 0xff000000u | (*rgb & 0xff) << 16 | (*rgb & 0xff00) | *rgb >> 16;
    }

    void edges() {
        const json* list = tags_.find("edges");
        if (!list) return;
        size_t count = 0;
        for (const auto& ring : f_.rings) count += ring.size();
        if (!list->is_array()) return warn("edges", "is not a list");
        size_t left = count;  // an entry an edge: more would be gone through for each polygon of a feature
        for (const json& entry : *list) {
            if (left-- == 0) return warn("edges", "has more entries than there are edges: those behind them");
            if (!entry.is_object() || !entry.contains("edge") || !entry["edge"].is_number_unsigned()) {
                warn("edges", "has an entry without the number of its edge");
                continue;
            }
            uint64_t edge = entry["edge"].get<uint64_t>();
            if (edge >= count) {
                warn("edges", "names edge " + std::to_string(edge) + " of " + std::to_string(count));
                continue;
            }
            EdgeRoof own{uint32_t(edge), {}, {}};
            if (entry.contains("gable") && entry["gable"].is_boolean()) own.gable = entry["gable"].get<bool>();
            if (entry.contains("angle")) {
                std::optional<double> angle = readNumber(entry["angle"]);
                if (angle && *angle > 0 && *angle <= 85)
                    own.slope = std::tan(glm::radians(*angle));
                else
                    warn("edges", "has an angle that is not between 0 and 85");
            }
            f_.edges.push_back(own);
        }
    }

    const FeatureTags& tags_;
    const std::string& file_;
    Footprint& f_;
    std::vector<Diagnostic>& diagnostics_;
};

}  // namespace

void applyTags(const FeatureTags& tags, const std::string& file, Footprint& footprint,
               std::vector<Diagnostic>& diagnostics) {
    Tags(tags, file, footprint, diagnostics).apply();
}

void tellUnknownTags(const FeatureTags& tags, const std::string& file, const std::string& id,
                     std::vector<Diagnostic>& diagnostics) {
    static constexpr std::array known{"roof:shape",       "roof:height",         "roof:angle",  "roof:direction",
                                      "roof:orientation", "roof:material",       "roof:colour", "roof:color",
                                      "roof:levels",      "roof:slope:direction"};
    tags.forKeys([&](const std::string& key) {
        if (key.rfind("roof:", 0) == 0 && std::find(known.begin(), known.end(), key) == known.end())
            diagnostics.push_back({file, 0, 0, id, key.substr(0, 40) + " is not known: ignored", true});
    });
}

}  // namespace espalier
