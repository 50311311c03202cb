// In: GeoJSON (RFC 7946) or a plan in metres. Out: footprints in metres east and north of the town's middle. Each
// feature stands alone: what is wrong with one is said with its id, and the rest of the town stands.
#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "runtime/core/file.hpp"
#include "runtime/roof/footprint_crs.hpp"
#include "runtime/roof/footprint_kinds.hpp"
#include "runtime/roof/footprint_neighbours.hpp"
#include "runtime/roof/footprint_parts.hpp"
#include "runtime/roof/footprint_place.hpp"
#include "runtime/roof/footprint_tags.hpp"

namespace espalier {

namespace {

using nlohmann::json;
using Ring = std::vector<glm::dvec2>;

constexpr size_t kMostFeatures = 4u << 20;
constexpr double kNearestPole = 85;  // degrees of latitude
constexpr const char* kConvert =
    "Convert it to WGS 84 first, for example with ogr2ogr -t_srs EPSG:4326 NEW.geojson OLD.geojson";

std::string shown(const std::string& crsName) {
    return "'" + crsName.substr(0, 80) + "'";
}

class Reader {
  public:
    // crs: of a GeoJSON; none for plans in metres. crsName: as the file writes it, if it does.
    Reader(const std::string& file, Listing listing, std::optional<CoordinateSystem> crs,
           const std::optional<std::string>& crsName)
        : file_(file), listing_(listing), crs_(crs), crsName_(crsName) {}
    Town town;

    void feature(const json& feature, size_t number) {
        if (!feature.is_object()) return say("feature " + std::to_string(number), "is not an object: left out");
        const json& properties = feature.contains("properties") ? feature["properties"] : feature;
        const std::string id = idOf(feature, properties, number);
        const FeatureTags tags(properties);
        if (std::optional<std::string> why = whyNoHouse(tags, listing_)) return leftOut_.add(std::move(*why));
        std::vector<Diagnostic> said;
        tellUnknownTags(tags, file_, id, said);
        addMessages(town.diagnostics, std::move(said));
        if (!crs_) return plan(feature, tags, id);
        if (!feature.contains("geometry")) return say(id, "has no geometry: left out");
        geometry(feature["geometry"], tags, id);
    }

    void geometry(const json& geometry, const FeatureTags& tags, const std::string& id) {
        if (!geometry.is_object() || !geometry.contains("type") || !geometry["type"].is_string())
            return say(id, "has no geometry: left out");
        const std::string type = geometry["type"].get<std::string>();
        if (type == "Point" || type == "MultiPoint" || type == "MultiLineString") return leftOut_.add(type);
        if (type != "LineString" && type != "Polygon" && type != "MultiPolygon")
            return say(id, "is a " + type.substr(0, 40) + ", not a Polygon or MultiPolygon: left out");
        if (!geometry.contains("coordinates") || !geometry["coordinates"].is_array())
            return say(id, "has no coordinates: left out");
        const json& coordinates = geometry["coordinates"];
        if (type == "LineString") return line(coordinates, tags, id);
        if (type == "Polygon") return polygon(coordinates, tags, id);
        for (size_t i = 0; i < coordinates.size(); i++)
            polygon(coordinates[i], tags, coordinates.size() == 1 ? id : id + "#" + std::to_string(i + 1));
    }

    // The town in metres, without what stands twice. Fails where none of its coordinates can be meant.
    Status finish() {
        if (Status sound = judgeCoordinates(); !sound) return sound;
        placeTown(town, crs_.has_value(), file_);
        leaveOutlinesToParts(town);
        findNeighbours(town);
        if (!leftOut_.empty()) addMessages(town.diagnostics, {{file_, 0, 0, {}, leftOut_.text(), true}});
        return Done{};
    }

    void say(const std::string& id, const std::string& what) {
        addMessages(town.diagnostics, {{file_, 0, 0, id, what, false}});
    }

  private:
    static std::string idOf(const json& feature, const json& properties, size_t number) {
        for (const json* object : {&feature, &properties})
            for (const char* key : {"id", "@id", "osm", "osm_id", "full_id", "osmid", "osm_way_id"}) {
                if (!object->is_object() || !object->contains(key)) continue;
                const json& id = (*object)[key];
                if (id.is_string()) return id.get<std::string>().substr(0, 100);
                if (id.is_number_integer()) return std::to_string(id.get<int64_t>());
            }
        return "feature " + std::to_string(number);
    }

    // {"outer": [[x, y], ...], "holes": [...]} with the tags beside them.
    void plan(const json& building, const FeatureTags& tags, const std::string& id) {
        if (!building.contains("outer")) return say(id, "has no outer ring: left out");
        std::vector<const json*> rings{&building["outer"]};
        if (building.contains("holes") && building["holes"].is_array())
            for (const json& hole : building["holes"]) rings.push_back(&hole);
        polygon(rings, tags, id);
    }

    // A closed way: some programs write outlines so.
    void line(const json& points, const FeatureTags& tags, const std::string& id) {
        const auto at = [](const json& point, size_t axis) {
            return point.is_array() && point.size() > axis && point[axis].is_number() ? point[axis].get<double>() : NAN;
        };
        const bool closed = points.size() >= 4 && at(points.front(), 0) == at(points.back(), 0) &&
                            at(points.front(), 1) == at(points.back(), 1);
        if (!namesBuilding(tags) || !closed) return leftOut_.add("LineString");
        polygon(std::vector<const json*>{&points}, tags, id);
    }

    void polygon(const json& coordinates, const FeatureTags& tags, const std::string& id) {
        if (!coordinates.is_array() || coordinates.empty()) return say(id, "has no rings: left out");
        std::vector<const json*> rings;
        for (const json& ring : coordinates) rings.push_back(&ring);
        polygon(rings, tags, id);
    }

    // Not copied: a copy recurses, however deep a file nests.
    void polygon(const std::vector<const json*>& rings, const FeatureTags& tags, const std::string& id) {
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

    const char* readRing(const json& points, Ring& ring) {
        if (!points.is_array()) return "is not a list of points";
        ring.reserve(points.size());
        for (const json& p : points) {
            if (!p.is_array() || p.size() < 2 || !p[0].is_number() || !p[1].is_number())
                return "has a point that isn't two numbers";
            glm::dvec2 q(p[0].get<double>(), p[1].get<double>());
            if (const char* problem = bring(q)) return problem;
            ring.push_back(q);
        }
        if (ring.size() > 1 && ring.front() == ring.back()) ring.pop_back();
        return ring.size() < 3 ? "has fewer than three corners" : nullptr;
    }

    // To degrees, or metres of a plan. Returns what is wrong with it.
    const char* bring(glm::dvec2& q) {
        if (!std::isfinite(q.x) || !std::isfinite(q.y)) return "has a coordinate that is no number";
        if (!crs_) return std::abs(q.x) > 1e7 || std::abs(q.y) > 1e7 ? "has a coordinate beyond 10,000 km" : nullptr;
        // Some programs go on beyond the antimeridian: 181, not -179.
        const bool likeDegrees = std::abs(q.x) <= 360 && std::abs(q.y) <= 90;
        (likeDegrees ? likeDegrees_ : unlikeDegrees_) = q;
        if (crs_->degrees() && !likeDegrees) return "has a coordinate out of range (degrees)";
        q = crs_->toDegrees(q);
        if (!(std::abs(q.x) <= 540) || !(std::abs(q.y) <= 90)) return "has a coordinate that its crs doesn't reach";
        return std::abs(q.y) > kNearestPole ? "has a coordinate out of range: too near a pole" : nullptr;
    }

    // Where every coordinate is of the wrong kind, that is one mistake of the file's and none of its features'.
    Status judgeCoordinates() const {
        const std::optional<glm::dvec2>& wrong = crs_ && crs_->degrees() ? unlikeDegrees_ : likeDegrees_;
        const std::optional<glm::dvec2>& right = crs_ && crs_->degrees() ? likeDegrees_ : unlikeDegrees_;
        if (!wrong || right) return Done{};
        char at[80];
        std::snprintf(at, sizeof at, "%.10g, %.10g", wrong->x, wrong->y);
        const std::string its = std::string("its coordinates, such as ") + at;
        if (!crsName_)
            return Failure(file_, its + ", are not WGS 84's degrees, and it names no crs in metres. " + kConvert);
        const std::string named = "its crs is " + shown(*crsName_);
        if (crs_->degrees()) return Failure(file_, named + ", but " + its + ", are not WGS 84's degrees. " + kConvert);
        return Failure(file_, named + ", not WGS 84 but in metres, and " + its + ", look like degrees. " + kConvert);
    }

    const std::string& file_;
    const Listing listing_;
    const std::optional<CoordinateSystem> crs_;
    const std::optional<std::string>& crsName_;
    std::optional<glm::dvec2> likeDegrees_, unlikeDegrees_;  // one of each kind of coordinates, if there is any
    LeftOut leftOut_;
};

// What the file as a whole says of its features.
Listing listingOf(const json& features) {
    for (const json& feature : features) {
        if (!feature.is_object()) continue;
        const auto properties = feature.find("properties");
        if (properties != feature.end() && namesBuilding(FeatureTags(*properties))) return Listing::tagged;
    }
    return Listing::bare;
}

// The system of a GeoJSON's coordinates; `said` gets a warning where it isn't WGS 84.
Result<CoordinateSystem> systemOf(const std::optional<std::string>& name, const std::string& file,
                                  std::vector<Diagnostic>& said) {
    const std::optional<int> epsg = name ? epsgOf(*name) : 4326;
    const std::optional<CoordinateSystem> crs = epsg ? CoordinateSystem::of(*epsg) : std::nullopt;
    const std::string is = "its crs is " + shown(name.value_or("")) + ", not WGS 84";
    if (!crs) return Failure(file, is + ", and none that is known. " + kConvert);
    if (*epsg != 4326)
        said.push_back(
            {file,
             0,
             0,
             {},
             is + (crs->degrees() ? ": its degrees are taken for WGS 84's" : ": its metres are brought to degrees"),
             true});
    return *crs;
}

Result<json> parseJson(const std::string& text, const std::string& file) {
    try {
        return json::parse(text);
    } catch (const json::parse_error& error) {
        // byte counts from 1
        size_t at = std::min(error.byte > 0 ? error.byte - 1 : 0, text.size());
        int line = 1 + int(std::count(text.begin(), text.begin() + std::ptrdiff_t(at), '\n'));
        size_t lineStart = at == 0 ? std::string::npos : text.rfind('\n', at - 1);
        int column = int(at - (lineStart == std::string::npos ? 0 : lineStart + 1)) + 1;
        std::string what = error.what();
        size_t cause = what.find("syntax error");
        what = (cause == std::string::npos ? what : what.substr(cause)).substr(0, 160);
        return Failure(Diagnostic{file, line, column, {}, "is not JSON: " + what});
    } catch (const std::exception& error) {
        return Failure(file, std::string("is not JSON that can be read: ") + error.what());
    }
}

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
    Result<json> parsed = parseJson(text, file);
    if (!parsed) return parsed.failure();
    const json& document = *parsed;
    if (!document.is_object()) return Failure(file, "is neither GeoJSON nor a plan: not an object");
    const bool plan = document.contains("buildings");
    const std::string type =
        document.contains("type") && document["type"].is_string() ? document["type"].get<std::string>() : "";
    const json* list = plan ? &document["buildings"] : document.contains("features") ? &document["features"] : nullptr;
    if (list && !list->is_array()) return Failure(file, "has no list of features or buildings");
    if (list && list->size() > kMostFeatures) return Failure(file, "has more than 4 million features");
    std::vector<Diagnostic> said;
    std::optional<CoordinateSystem> crs;
    const std::optional<std::string> named = crsName(document);
    if (!plan)
        if (Status known = assign(crs, systemOf(named, file, said)); !known) return known.failure();
    Reader reader(file, plan ? Listing::plan : list ? listingOf(*list) : Listing::bare, crs, named);
    reader.town.diagnostics = std::move(said);
    if (list) {
        for (size_t i = 0; i < list->size(); i++) reader.feature((*list)[i], i);
    } else if (type == "Feature") {
        reader.feature(document, 0);
    } else if (type == "Polygon" || type == "MultiPolygon") {
        const json untold;
        reader.geometry(document, FeatureTags(untold), "feature 0");
    } else {
        return Failure(file, "is neither GeoJSON with features nor a plan with buildings");
    }
    if (Status placed = reader.finish(); !placed) return placed.failure();
    return std::move(reader.town);
}

Result<Town> readFootprints(const std::string& path) {
    Result<std::string> text = readTextFile(path);
    if (!text) return text.failure();
    return parseFootprints(*text, path);
}

}  // namespace espalier
