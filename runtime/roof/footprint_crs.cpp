// In: coordinates in metres of a national or a UTM grid. Out: degrees. Formulas: Krueger's series for the transverse
// Mercator projection (to the fourth power of n: exact to the micrometre within its zone); IOGP's guidance note 7-2 for
// the conic and the oblique stereographic projection; swisstopo's approximation for the Swiss grids.
#include "runtime/roof/footprint_crs.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <nlohmann/json.hpp>

namespace espalier {

namespace {

constexpr double kPi = 3.14159265358979323846;

// The sum of c[j] sin(2 (j + 1) x).
double sines(const std::array<double, 4>& c, double x) {
    double sum = 0;
    for (size_t j = 0; j < c.size(); ++j) sum += c[j] * std::sin(2 * double(j + 1) * x);
    return sum;
}

}  // namespace

std::optional<int> epsgOf(const std::string& name) {
    std::string upper = name.substr(0, 200);
    for (char& c : upper) c = char(std::toupper(static_cast<unsigned char>(c)));
    if (upper.ends_with("CRS84") || upper.ends_with("CRS84H")) return 4326;
    if (upper.find("EPSG") == std::string::npos && upper.find("ESRI") == std::string::npos) return {};
    size_t end = upper.size();
    while (end > 0 && !std::isdigit(static_cast<unsigned char>(upper[end - 1]))) --end;
    size_t begin = end;
    while (begin > 0 && std::isdigit(static_cast<unsigned char>(upper[begin - 1]))) --begin;
    if (begin == end || end - begin > 7) return {};
    return std::stoi(upper.substr(begin, end - begin));
}

std::optional<std::string> crsName(const nlohmann::json& document) {
    const auto crs = document.find("crs");
    if (crs == document.end() || crs->is_null()) return {};
    if (crs->is_string()) return crs->get<std::string>();
    const auto properties = crs->is_object() ? crs->find("properties") : crs->end();
    if (crs->is_object() && properties != crs->end() && properties->is_object())
        for (const char* key : {"name", "href", "code"}) {
            const auto name = properties->find(key);
            if (name == properties->end()) continue;
            if (name->is_string()) return name->get<std::string>();
            if (name->is_number_unsigned()) return "EPSG:" + std::to_string(name->get<uint64_t>());
        }
    return crs->dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
}

std::optional<CoordinateSystem> CoordinateSystem::of(int epsg) {
    constexpr Ellipsoid grs80{6378137, 298.257222101}, wgs84{6378137, 298.257223563}, bessel{6377397.155, 299.1528128},
        airy{6377563.396, 299.3249646}, international{6378388, 297};
    switch (epsg) {
        case 7844:
        case 6668:
        case 6318:
            return CoordinateSystem{Kind::degrees, wgs84, {}};
        case 3857:
        case 900913:
        case 102100:
        case 3785:
            return CoordinateSystem{Kind::webMercator, wgs84, {}};
        case 27700:
            return CoordinateSystem{Kind::transverseMercator, airy, {49, -2, .9996012717, 400000, -100000}};
        case 2157:
            return CoordinateSystem{Kind::transverseMercator, grs80, {53.5, -8, .99982, 600000, 750000}};
        case 3067:
            return CoordinateSystem{Kind::transverseMercator, grs80, {0, 27, .9996, 500000, 0}};
        case 4647:  // UTM with the zone's number before the metres
            return CoordinateSystem{Kind::transverseMercator, grs80, {0, 9, .9996, 32500000, 0}};
        case 5650:
            return CoordinateSystem{Kind::transverseMercator, grs80, {0, 15, .9996, 33500000, 0}};
        case 3006:
            return CoordinateSystem{Kind::transverseMercator, grs80, {0, 15, .9996, 500000, 0}};
        case 2180:
            return CoordinateSystem{Kind::transverseMercator, grs80, {0, 19, .9993, 500000, -5300000}};
        case 2193:
            return CoordinateSystem{Kind::transverseMercator, grs80, {0, 173, .9996, 1600000, 10000000}};
        case 3763:
            return CoordinateSystem{Kind::transverseMercator, grs80, {39.66825833333333, -8.133108333333334, 1, 0, 0}};
        case 28992:
        case 7415:
            return CoordinateSystem{
                Kind::stereographic, bessel, {52.15616055555555, 5.38763888888889, .9999079, 155000, 463000}};
        case 2154:
            return CoordinateSystem{Kind::conic, grs80, {46.5, 3, 1, 700000, 6600000, 49, 44}};
        case 31370:
            return CoordinateSystem{Kind::conic,
                                    international,
                                    {90, 4.367486666666666, 1, 150000.013, 5400088.438, 51.16666723333333, 49.8333339}};
        case 3812:
            return CoordinateSystem{
                Kind::conic,
                grs80,
                {50.797815, 4.359215833333333, 1, 649328, 665262, 49.83333333333334, 51.16666666666666}};
        case 2056:
            return CoordinateSystem{Kind::swiss, bessel, {0, 0, 1, 2600000, 1200000}};
        case 21781:
            return CoordinateSystem{Kind::swiss, bessel, {0, 0, 1, 600000, 200000}};
        default:
            break;
    }
    if (epsg >= 4001 && epsg <= 4999) return CoordinateSystem{Kind::degrees, wgs84, {}};  // most are geographic
    return zone(epsg);
}

// The families of UTM and their like: a zone of six degrees each.
std::optional<CoordinateSystem> CoordinateSystem::zone(int epsg) {
    constexpr Ellipsoid grs80{6378137, 298.257222101}, wgs84{6378137, 298.257223563}, bessel{6377397.155, 299.1528128},
        international{6378388, 297};
    if (epsg >= 31466 &&
        epsg <= 31469) {  // Gauss and Krueger's zones of three degrees, by their number before the metres
        const int number = epsg - 31464;
        return CoordinateSystem{Kind::transverseMercator, bessel, {0, 3.0 * number, 1, number * 1e6 + 500000, 0}};
    }
    if (epsg >= 3942 && epsg <= 3950) {  // France's nine cones, a degree of latitude each
        const double latitude = epsg - 3900, north = (epsg - 3941) * 1e6 + 200000;
        return CoordinateSystem{Kind::conic, grs80, {latitude, 3, 1, 1700000, north, latitude - .75, latitude + .75}};
    }
    struct Family {
        int first, last, firstZone;
        double north;
        Ellipsoid ellipsoid;
    };
    static constexpr Family families[] = {
        {32601, 32660, 1, 0, wgs84},          {32701, 32760, 1, 10000000, wgs84},   // WGS 84
        {25828, 25838, 28, 0, grs80},         {26901, 26923, 1, 0, grs80},          // ETRS89, NAD83
        {28348, 28358, 48, 10000000, grs80},  {7846, 7859, 46, 10000000, grs80},    // GDA94, GDA2020
        {31965, 31976, 11, 0, grs80},         {31977, 31985, 17, 10000000, grs80},  // SIRGAS 2000
        {23028, 23038, 28, 0, international},                                       // ED50
    };
    for (const Family& f : families) {
        if (epsg < f.first || epsg > f.last) continue;
        const double meridian = 6 * (f.firstZone + epsg - f.first) - 183;
        return CoordinateSystem{Kind::transverseMercator, f.ellipsoid, {0, meridian, .9996, 500000, f.north}};
    }
    return {};
}

glm::dvec2 CoordinateSystem::toDegrees(glm::dvec2 p) const {
    if (kind_ == Kind::degrees) return p;
    p -= glm::dvec2(at_.east, at_.north);
    switch (kind_) {
        case Kind::webMercator:
            return glm::degrees(glm::dvec2(p.x / ellipsoid_.radius, std::atan(std::sinh(p.y / ellipsoid_.radius))));
        case Kind::transverseMercator:
            return fromMercator(p);
        case Kind::conic:
            return fromConic(p);
        case Kind::stereographic:
            return fromStereographic(p);
        default:
            break;
    }
    const double y = p.x / 1e6, x = p.y / 1e6;
    const double longitude = 2.6779094 + 4.728982 * y + .791484 * y * x + .1306 * y * x * x - .0436 * y * y * y;
    const double latitude =
        16.9023892 + 3.238272 * x - .270978 * y * y - .002528 * x * x - .0447 * y * y * x - .0140 * x * x * x;
    return glm::dvec2(longitude, latitude) * (100. / 36);
}

double CoordinateSystem::eccentricity() const {
    const double f = 1 / ellipsoid_.inverseFlattening;
    return std::sqrt(f * (2 - f));
}

double CoordinateSystem::third() const {
    const double f = 1 / ellipsoid_.inverseFlattening;
    return f / (2 - f);
}

double CoordinateSystem::conformal(double latitude) const {
    const double e = eccentricity(), s = std::sin(latitude);
    return std::atan(std::sinh(std::atanh(s) - e * std::atanh(e * s)));
}

double CoordinateSystem::geodetic(double conformal) const {
    const double n = third(), n2 = n * n, n3 = n2 * n, n4 = n3 * n;
    return conformal + sines({2 * n - 2 * n2 / 3 - 2 * n3 + 116 * n4 / 45, 7 * n2 / 3 - 8 * n3 / 5 - 227 * n4 / 45,
                              56 * n3 / 15 - 136 * n4 / 35, 4279 * n4 / 630},
                             conformal);
}

glm::dvec2 CoordinateSystem::fromMercator(glm::dvec2 p) const {
    const double n = third(), n2 = n * n, n3 = n2 * n, n4 = n3 * n;
    const double rectifying = ellipsoid_.radius / (1 + n) * (1 + n2 / 4 + n4 / 64);
    const double chi0 = conformal(glm::radians(at_.latitude));
    const double begin =
        chi0 + sines({n / 2 - 2 * n2 / 3 + 5 * n3 / 16 + 41 * n4 / 180, 13 * n2 / 48 - 3 * n3 / 5 + 557 * n4 / 1440,
                      61 * n3 / 240 - 103 * n4 / 140, 49561 * n4 / 161280},
                     chi0);
    const double xi = begin + p.y / (at_.scale * rectifying), eta = p.x / (at_.scale * rectifying);
    const double beta[] = {n / 2 - 2 * n2 / 3 + 37 * n3 / 96 - n4 / 360, n2 / 48 + n3 / 15 - 437 * n4 / 1440,
                           17 * n3 / 480 - 37 * n4 / 840, 4397 * n4 / 161280};
    double north = xi, east = eta;
    for (int j = 0; j < 4; ++j) {
        const double twice = 2 * (j + 1);
        north -= beta[j] * std::sin(twice * xi) * std::cosh(twice * eta);
        east -= beta[j] * std::cos(twice * xi) * std::sinh(twice * eta);
    }
    const double latitude = geodetic(std::asin(std::sin(north) / std::cosh(east)));
    return glm::dvec2(at_.longitude, 0) +
           glm::degrees(glm::dvec2(std::atan2(std::sinh(east), std::cos(north)), latitude));
}

glm::dvec2 CoordinateSystem::fromConic(glm::dvec2 p) const {
    const double e = eccentricity();
    // The parallel's radius over the ellipsoid's, and the tangent of half the conformal colatitude.
    const auto m = [&](double latitude) {
        const double s = std::sin(latitude);
        return std::cos(latitude) / std::sqrt(1 - e * e * s * s);
    };
    const auto t = [&](double latitude) { return std::tan((kPi / 2 - conformal(latitude)) / 2); };
    const double first = glm::radians(at_.parallel1), second = glm::radians(at_.parallel2);
    const double n = (std::log(m(first)) - std::log(m(second))) / (std::log(t(first)) - std::log(t(second)));
    const double f = ellipsoid_.radius * m(first) / (n * std::pow(t(first), n));
    const double origin = at_.latitude < 90 ? f * std::pow(t(glm::radians(at_.latitude)), n) : 0;
    const double radius = glm::length(glm::dvec2(p.x, origin - p.y));
    const double angle = std::atan2(p.x, origin - p.y);
    const double latitude = geodetic(kPi / 2 - 2 * std::atan(std::pow(radius / f, 1 / n)));
    return glm::dvec2(at_.longitude, 0) + glm::degrees(glm::dvec2(angle / n, latitude));
}

glm::dvec2 CoordinateSystem::fromStereographic(glm::dvec2 p) const {
    const double e = eccentricity(), phi = glm::radians(at_.latitude), s = std::sin(phi), c = std::cos(phi);
    const double w = 1 - e * e * s * s;
    // Of the sphere onto which the ellipsoid is laid first.
    const double radius = ellipsoid_.radius * std::sqrt(1 - e * e) / w;
    const double n = std::sqrt(1 + e * e * c * c * c * c / (1 - e * e));
    const double w1 = std::pow((1 + s) / (1 - s) * std::pow((1 - e * s) / (1 + e * s), e), n);
    const double sine0 = (w1 - 1) / (w1 + 1);
    const double shift = (n + s) * (1 - sine0) / ((n - s) * (1 + sine0));
    const double chi0 = std::asin((shift * w1 - 1) / (shift * w1 + 1));
    const double twice = 2 * radius * at_.scale;
    const double g = twice * std::tan(kPi / 4 - chi0 / 2), h = 2 * twice * std::tan(chi0) + g;
    const double i = std::atan2(p.x, h + p.y), j = std::atan2(p.x, g - p.y) - i;
    const double chi = chi0 + 2 * std::atan((p.y - p.x * std::tan(j / 2)) / twice);
    const double isometric = std::log((1 + std::sin(chi)) / (shift * (1 - std::sin(chi)))) / (2 * n);
    const double latitude = geodetic(2 * std::atan(std::exp(isometric)) - kPi / 2);
    return glm::dvec2(at_.longitude, 0) + glm::degrees(glm::dvec2((j + 2 * i) / n, latitude));
}

}  // namespace espalier
