// In: a bake's figures. Out: the JSON report.
#include <nlohmann/json.hpp>

#include "tools/bake/bake.hpp"

namespace espalier {

std::string BakeReport::json() const {
    using nlohmann::ordered_json;
    ordered_json j;
    j["source"] = source;
    j["triangles"] = triangles;
    j["charts"] = charts;
    j["made_charts"] = madeCharts;
    j["layout"] = layoutKept ? "kept" : "made";
    j["uvs"] = ordered_json::array();
    for (const UvFate& u : uvs) j["uvs"].push_back({{"cause", u.cause}, {"charts", u.charts}, {"area", u.area}});
    j["overlapping_texels"] = overlaps;
    j["texels"] = {{"inner", innerTexels}, {"link", linkTexels}, {"open", openTexels}, {"buried", buriedTexels}};
    j["crossings"] = {{"seam", seamCrossings},
                      {"nearest", nearestCrossings},
                      {"contact", contactCrossings},
                      {"dangling", danglingCrossings},
                      {"dangling_contacts", danglingContacts}};
    j["walkable_area"] = walkableArea;
    j["stretch"] = {{"p50", stretch50}, {"p95", stretch95}, {"max", stretchMax}};
    j["round_trip_texels"] = {{"p50", roundTrip50}, {"p999", roundTrip999}};
    j["gap_texels"] = {{"p999", gap999}};
    j["levels"] = ordered_json::array();
    for (const auto& [size, share] : walkableByLevel) j["levels"].push_back({{"size", size}, {"walkable", share}});
    j["seconds"] = ordered_json::object();
    for (const auto& [stage, time] : seconds) j["seconds"][stage] = time;
    j["warnings"] = ordered_json::array();
    for (const Diagnostic& d : warnings) j["warnings"].push_back(toString(d));
    return j.dump(2, ' ', false, ordered_json::error_handler_t::replace) + "\n";
}

}  // namespace espalier
