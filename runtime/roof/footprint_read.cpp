// In: GeoJSON (RFC 7946) or a plan in metres. Out: footprints in metres east and north of the town's middle. Each
// feature stands alone: what is wrong with one is said with its id, and the rest of the town stands.
#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "runtime/core/file.hpp"
#include "runtime/roof/footprint_parts.hpp"
#include "runtime/roof/footprint_tags.hpp"

namespace espalier {

namespace {

using nlohmann::json;
using Ring = std::vector<glm::dvec2>;

constexpr double kFarthest = 100000;  // metres from the town's middle
constexpr size_t kMostFeatures = 4u << 20;

class Reader {
  public:
    Reader(const std::string& file, bool metres) : file_(file), metres_(metres) {}
    Town town;

    void feature(const json& feature, size_t number) {
        if (!feature.is_object()) return say("feature " + std::to_string(number), "is not an object: left out");
        const json& tags = feature.contains("properties") ? feature["properties"] : feature;
        std::string id = idOf(feature, tags, number);
        std::vector<Diagnostic> said;
        tellUnknownTags(tags, file_, id, said);
        addMessages(town.diagnostics, std::move(said));
        if (metres_) return plan(feature, id);
        if (!feature.contains("geometry")) return say(id, "has no geometry: left out");
        geometry(feature["geometry"], tags, id);
    }

    void geometry(const json& geometry, const json& tags, const std::string& id) {
        if (!geometry.is_object() || !geometry.contains("type") || !geometry["type"].is_string())
            return say(id, "has no geometry: left out");
        std::string type = geometry["type"].get<std::string>();
        if (type != "Polygon" && type != "MultiPolygon")
            return say(id, "is a " + type.substr(0, 40) + ", not a Polygon or MultiPolygon: left out");
        if (!geometry.contains("coordinates") || !geometry["coordinates"].is_array())
            return say(id, "has no coordinates: left out");
        const json& coordinates = geometry["coordinates"];
        if (type == "Polygon") return polygon(coordinates, tags, id);
        for (size_t i = 0; i < coordinates.size(); i++)
            polygon(coordinates[i], tags, coordinates.size() == 1 ? id : id + "#" + std::to_string(i + 1));
    }

    // Degrees become metres about the town's middle: the median of the features, which one stray feature doesn't move.
    void place() {
        if (metres_ || town.footprints.empty()) return;
        std::vector<double> lon, lat;
        for (const Footprint& f : town.footprints) lon.push_back(f.rings[0][0].x), lat.push_back(f.rings[0][0].y);
        auto median = [](std::vector<double>& v) {
            std::nth_element(v.begin(), v.begin() + std::ptrdiff_t(v.size() / 2), v.end());
            return v[v.size() / 2];
        };
        town.originLonLat = {median(lon), median(lat)};
        // WGS 84's radii of curvature there.
        constexpr double a = 6378137, e2 = 6.69437999014e-3;
        double phi = glm::radians(town.originLonLat.y), w = 1 - e2 * std::sin(phi) * std::sin(phi);
        glm::dvec2 metres =
            glm::radians(1.0) * glm::dvec2(a / std::sqrt(w) * std::cos(phi), a * (1 - e2) / (w * std::sqrt(w)));
        auto far = [&](Footprint& f) {
            double farthest = 0;
            for (Ring& ring : f.rings)
                for (glm::dvec2& p : ring) {
                    p = (p - town.originLonLat) * metres;
                    farthest = std::max(farthest, glm::length(p));
                }
            if (farthest <= kFarthest) return false;
            say(f.id, "lies more than 100 km from the middle of the town: left out");
            return true;
        };
        std::vector<Footprint>& all = town.footprints;
        all.erase(std::remove_if(all.begin(), all.end(), far), all.end());
    }

    void say(const std::string& id, const std::string& what) {
        addMessages(town.diagnostics, {{file_, 0, 0, id, what, false}});
    }

  private:
    static std::string idOf(const json& feature, const json& tags, size_t number) {
        for (const json* object : {&feature, &tags})
            for (const char* key : {"id", "@id", "osm", "osm_id"}) {
                if (!object->is_object() || !object->contains(key)) continue;
                const json& id = (*object)[key];
                if (id.is_string()) return id.get<std::string>().substr(0, 100);
                if (id.is_number_integer()) return std::to_string(id.get<int64_t>());
            }
        return "feature " + std::to_string(number);
    }

    // {"outer": [[x, y], ...], "holes": [...]} with the tags beside them.
    void plan(const json& building, const std::string& id) {
        if (!building.contains("outer")) return say(id, "has no outer ring: left out");
        std::vector<const json*> rings{&building["outer"]};
        if (building.contains("holes") && building["holes"].is_array())
            for (const json& hole : building["holes"]) rings.push_back(&hole);
        polygon(rings, building, id);
    }

    void polygon(const json& coordinates, const json& tags, const std::string& id) {
        if (!coordinates.is_array() || coordinates.empty()) return say(id, "has no rings: left out");
        std::vector<const json*> rings;
        for (const json& ring : coordinates) rings.push_back(&ring);
        polygon(rings, tags, id);
    }

    // Not copied: a copy recurses, however deep a file nests.
    void polygon(const std::vector<const json*>& rings, const json& tags, const std::string& id) {
        Footprint f;
        f.id = id;
        size_t corners = 0;
        for (size_t r = 0; r < rings.size(); r++) {
            Ring ring;
            if (const char* problem = readRing(*rings[r], ring)) {
                if (r == 0) return say(id, std::string("its outline ") + problem + ": left out");
                say(id, "hole " + std::to_string(r) + " " + problem + ": filled");
                continue;
            }
            corners += ring.size();
            f.rings.push_back(std::move(ring));
        }
        if (corners > kMostCorners)
            return say(id, "has " + std::to_string(corners) + " corners, more than " + std::to_string(kMostCorners) +
                               ": left out");
        std::vector<Diagnostic> said;
        applyTags(tags, file_, f, said);
        addMessages(town.diagnostics, std::move(said));
        town.footprints.push_back(std::move(f));
    }

    const char* readRing(const json& points, Ring& ring) const {
        if (!points.is_array()) return "is not a list of points";
        ring.reserve(points.size());
        for (const json& p : points) {
            if (!p.is_array() || p.size() < 2 || !p[0].is_number() || !p[1].is_number())
                return "has a point that isn't two numbers";
            glm::dvec2 q(p[0].get<double>(), p[1].get<double>());
            if (!std::isfinite(q.x) || !std::isfinite(q.y)) return "has a coordinate that is no number";
            if (metres_ ? std::abs(q.x) > 1e7 || std::abs(q.y) > 1e7 : std::abs(q.x) > 180 || std::abs(q.y) > 85)
                return metres_ ? "has a coordinate beyond 10,000 km" : "has a coordinate out of range (degrees)";
            ring.push_back(q);
        }
        if (ring.size() > 1 && ring.front() == ring.back()) ring.pop_back();
        return ring.size() < 3 ? "has fewer than three corners" : nullptr;
    }

    const std::string& file_;
    const bool metres_;
};

}  // namespace

void addMessages(std::vector<Diagnostic>& all, std::vector<Diagnostic> more) {
    for (Diagnostic& d : more) {
        if (all.size() > kMostMessages) return;
        if (all.size() == kMostMessages)
            d = {d.file, 0, 0, {}, "more than " + std::to_string(kMostMessages) + " messages: the rest is left out",
                 true};
        all.push_back(std::move(d));
    }
}

Result<Town> parseFootprints(const std::string& text, const std::string& file) {
    json document;
    try {
        document = json::parse(text);
    } catch (const json::parse_error& error) {
        // byte counts from 1
        size_t at = std::min(error.byte > 0 ? error.byte - 1 : 0, text.size());
        int line = 1 + int(std::count(text.begin(), text.begin() + std::ptrdiff_t(at), '\n'));
        size_t lineStart = at == 0 ? std::string::npos : text.rfind('\n', at - 1);
        int column = int(at - (lineStart == std::string::npos ? 0 : lineStart + 1)) + 1;
        std::string what = error.what();
        size_t cause = what.find("syntax error");
        return Failure(
            Diagnostic{file,
                       line,
                       column,
                       {},
                       "is not JSON: " + (cause == std::string::npos ? what : what.substr(cause)).substr(0, 160)});
    } catch (const std::exception& error) {
        return Failure(file, std::string("is not JSON that can be read: ") + error.what());
    }
    if (!document.is_object()) return Failure(file, "is neither GeoJSON nor a plan: not an object");
    bool metres = document.contains("buildings");
    std::string type =
        document.contains("type") && document["type"].is_string() ? document["type"].get<std::string>() : "";
    Reader reader(file, metres);
    const json* list = metres                          ? &document["buildings"]
                       : document.contains("features") ? &document["features"]
                                                       : nullptr;
    if (list) {
        if (!list->is_array()) return Failure(file, "has no list of features or buildings");
        if (list->size() > kMostFeatures) return Failure(file, "has more than 4 million features");
        for (size_t i = 0; i < list->size(); i++) reader.feature((*list)[i], i);
    } else if (type == "Feature") {
        reader.feature(document, 0);
    } else if (type == "Polygon" || type == "MultiPolygon") {
        reader.geometry(document, json::object(), "feature 0");
    } else {
        return Failure(file, "is neither GeoJSON with features nor a plan with buildings");
    }
    reader.place();
    leaveOutlinesToParts(reader.town);
    return std::move(reader.town);
}

Result<Town> readFootprints(const std::string& path) {
    Result<std::string> text = readTextFile(path);
    if (!text) return text.failure();
    return parseFootprints(*text, path);
}

}  // namespace espalier
