// In: a bake's figures. Out: the JSON report.
#include <algorithm>
#include <nlohmann/json.hpp>

#include "tools/bake/bake.hpp"

namespace espalier {
namespace {

constexpr double kWorthTelling = 1e-3;  // of the ground: of smaller pieces the report doesn't tell
constexpr size_t kMostPieces = 16;      // that it lists
constexpr uint32_t kFewestWalks = 20;   // of which a share that ends is told

double groundOf(const std::vector<PieceReach>& pieces) {
    double sum = 0;
    for (const PieceReach& p : pieces) sum += p.area;
    return sum;
}

}  // namespace

double PieceReach::share() const {
    const double ends = walks >= kFewestWalks ? double(ended) / walks : 0;
    return area > 0 ? reachable / area * (1 - ends) : 1;
}

double BakeReport::endedWalks() const {
    uint32_t walks = 0, ended = 0;
    for (const PieceReach& p : pieces) walks += p.walks, ended += p.ended;
    return walks > 0 ? double(ended) / walks : 0;
}

double BakeReport::reachableShare() const {
    double reachable = 0;
    for (const PieceReach& p : pieces) reachable += p.area * p.share();
    const double all = groundOf(pieces);
    return all > 0 ? reachable / all : 1;
}

double BakeReport::leastReachable() const {
    double least = 1;
    const double worth = kWorthTelling * groundOf(pieces);
    for (const PieceReach& p : pieces)
        if (p.area >= worth && p.area > 0) least = std::min(least, p.share());
    return least;
}

std::string BakeReport::json() const {
    using nlohmann::ordered_json;
    ordered_json j;
    j["source"] = source;
    j["origin"] = {origin.x, origin.y, origin.z};
    j["triangles"] = triangles;
    j["charts"] = charts;
    j["made_charts"] = madeCharts;
    j["layout"] = layoutKept ? "kept" : "made";
    j["uvs"] = ordered_json::array();
    for (const UvFate& u : uvs) j["uvs"].push_back({{"cause", u.cause}, {"charts", u.charts}, {"area", u.area}});
    j["overlapping_texels"] = overlaps;
    j["texels"] = {{"inner", innerTexels},
                   {"link", linkTexels},
                   {"open", openTexels},
                   {"buried", buriedTexels},
                   {"bare", bareTexels}};
    j["crossings"] = {{"seam", seamCrossings},
                      {"nearest", nearestCrossings},
                      {"contact", contactCrossings},
                      {"dangling", danglingCrossings},
                      {"dangling_contacts", danglingContacts}};
    j["reachable"] = {{"share", reachableShare()},
                      {"least", leastReachable()},
                      {"ended_walks", endedWalks()},
                      {"pieces", ordered_json::array()}};
    for (size_t i = 0; i < std::min(pieces.size(), kMostPieces); ++i)
        j["reachable"]["pieces"].push_back(
            {{"area", pieces[i].area}, {"share", pieces[i].share()}, {"enclosed", pieces[i].enclosed}});
    j["touching_metres"] = touching;
    j["materials"] = ordered_json::array();
    for (const MaterialArea& m : materials)
        if (m.area > 0) j["materials"].push_back({{"name", m.name}, {"area", m.area}, {"bare", m.bare}});
    j["threads"] = ordered_json::array();
    for (const Thread& t : threads)
        j["threads"].push_back({{"material", t.material},
                                {"pieces", t.pieces},
                                {"area", t.area},
                                {"texels", t.texels},
                                {"metres", t.metres},
                                {"at", {t.at.x, t.at.y, t.at.z}},
                                {"wants", t.wants}});
    j["walkable_area"] = walkableArea;
    j["charted"] = charted;
    const auto spread = [](const Distortion& d) {
        return ordered_json{{"p50", d.p50}, {"p95", d.p95}, {"max", d.max}};
    };
    j["stretch"] = {{"p50", stretch50},
                    {"p95", stretch95},
                    {"max", stretchMax},
                    {"area", spread(ofArea)},
                    {"angle", spread(ofAngle)}};
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
