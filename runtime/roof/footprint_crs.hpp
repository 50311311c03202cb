#pragma once

// Coordinate reference systems of GeoJSON files: degrees, and the metre grids that are common in Europe and elsewhere.

#include <glm/glm.hpp>
#include <optional>
#include <string>

#include <nlohmann/json_fwd.hpp>

namespace espalier {

// The number of an EPSG system in any of the usual spellings: "EPSG:25832", "urn:ogc:def:crs:EPSG::25832", an address
// that ends in it. CRS84 is 4326, and ESRI's numbers count as EPSG's. None: another authority's name.
std::optional<int> epsgOf(const std::string& name);

// The name in a GeoJSON's `crs` member, as it is written there. None: there is no such member, or it is null.
std::optional<std::string> crsName(const nlohmann::json& document);

// Brings coordinates of one system to degrees. Older datums (Amersfoort, OSGB36) are taken for WGS 84: what stands on
// them keeps its shape and lies up to 200 m from its true place.
class CoordinateSystem {
  public:
    // None: the system is not one of those that are known.
    static std::optional<CoordinateSystem> of(int epsg);

    bool degrees() const { return kind_ == Kind::degrees; }
    // Longitude and latitude; what lies outside of the system's reach comes out as no number, or far away.
    glm::dvec2 toDegrees(glm::dvec2 p) const;

  private:
    enum class Kind { degrees, webMercator, transverseMercator, conic, stereographic, swiss };
    struct Ellipsoid {
        double radius, inverseFlattening;
    };
    // Degrees and metres; `scale` on the origin's meridian, or where a conic's first parallel lies.
    struct Parameters {
        double latitude, longitude, scale, east, north, parallel1 = 0, parallel2 = 0;
    };
    CoordinateSystem(Kind kind, Ellipsoid ellipsoid, Parameters parameters)
        : kind_(kind), ellipsoid_(ellipsoid), at_(parameters) {}
    static std::optional<CoordinateSystem> zone(int epsg);

    double eccentricity() const;
    double third() const;                     // flattening n = (a - b) / (a + b)
    double conformal(double latitude) const;  // radians
    double geodetic(double conformal) const;  // its inverse
    glm::dvec2 fromMercator(glm::dvec2 p) const;
    glm::dvec2 fromConic(glm::dvec2 p) const;
    glm::dvec2 fromStereographic(glm::dvec2 p) const;

    Kind kind_;
    Ellipsoid ellipsoid_;
    Parameters at_;
};

}  // namespace espalier
