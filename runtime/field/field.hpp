#pragma once

// Tangent fields at the vertices of a mesh: designed from elements, or the surface's own curvature.

#include <complex>
#include <memory>
#include <string>
#include <vector>

#include "runtime/core/result.hpp"
#include "runtime/field/field_mesh.hpp"
#include "runtime/field/field_samples.hpp"

namespace espalier {

// A field of directions that are the same after a turn by 2 pi / symmetry: 1 a vector field, 2 a field of lines, as the
// eigenvectors of a symmetric tensor are, 4 a cross field.
//
// power[v] is the direction's N-th power, exp(i N angle), in the measure of angles of the mesh's vertex. Its length is
// 1, or 0 at an inner vertex about which the field turns, whose neighbours all have directions. deviator and mean: the
// eigenvalues of a tensor are mean + deviator, along the direction, and mean - deviator; of a vector field the length
// is the deviator.
struct Field {
    uint32_t symmetry = 2;
    std::vector<std::complex<double>> power;
    std::vector<float> mean, deviator;
    // Of an exact field: the turns that topology asked for beyond those of the elements, in N-ths of a whole turn, all
    // closed pieces together; those missing and those too much count alike.
    int unasked = 0;
    // Of a field with samples: vertices that have none near by. Their directions follow their neighbours'.
    size_t unsampled = 0;
};

// What a designer puts on a surface (Li 2011 §4.2, Fig. 6).
enum class ElementKind : uint32_t { regular, wedge, trisector, node, centre, saddle };
struct FieldElement {
    ElementKind kind = ElementKind::regular;
    glm::dvec3 position{0};         // object space, metres; the nearest vertex is meant
    glm::dvec3 direction{1, 0, 0};  // a regular element's, laid into the surface; a singular one is turned so that this
                                    // direction is one of the field's
    double radius = 0;              // metres, how far it is felt; 0: a tenth of the surface's radius
    bool operator==(const FieldElement&) const = default;
};

// A stroke of a brush over what all else asks for. A comb drags directions along its way; a smoothing brush lets them
// relax, as far as half its radius in one stroke.
enum class FieldBrush : uint32_t { comb, smooth };
struct FieldStroke {
    FieldBrush brush = FieldBrush::comb;
    std::vector<glm::vec3> points;  // object space, metres, on the surface; at most half a radius from one to the next
    double radius = 0;              // metres; 0: a tenth of the surface's radius
    double strength = .5;           // 0 to 1: of a comb, the share of the way there that one stroke turns its middle
};

// The turns that a field makes about an element, in whole turns: 1/2 for a wedge, -1 for a saddle.
double indexOf(ElementKind kind);
// Whether a field of this symmetry can have such an element.
bool fits(ElementKind kind, uint32_t symmetry);

struct FieldDesign {
    uint32_t symmetry = 2;
    std::vector<FieldElement> elements;
    glm::dvec3 drift{0, -1, 0};  // object space: where no element says otherwise the field leans to this direction
    double lean = 1;             // how much; 0: not at all
    bool exact = false;          // the elements' singularities and no others, but for those that topology asks for
    // The paper's way in place of the solve (Li 2011 §4.2): what elements and the drift ask for is summed up at each
    // vertex, and then so many passes of Laplacian smoothing go over it. Makes many singularities. Not together with
    // `exact`; samples are where it begins, and hold nothing.
    bool summed = false;
    uint32_t passes = 300;
    // The field that others have computed: it holds wherever it says something, but not within an element's radius.
    // Where the field is exact it turns each piece only as a whole, as the drift does. Null: there is none.
    std::shared_ptr<const FieldSamples> samples = {};
    std::vector<FieldStroke> strokes = {};  // later ones over earlier ones; also of an exact field
};

// The smoothest field that does what the design asks for: sparse solves over the whole mesh. Fails for an element
// that the symmetry doesn't allow, for samples as sampleVertices says, and where the mesh has no triangles.
Result<Field> designField(const FieldMesh& mesh, const FieldDesign& design);

// The tensor of curvature (Rusinkiewicz 2004, "Estimating curvatures and their derivatives on triangle meshes"):
// symmetry 2, the direction that of the larger principal curvature, 1/m, positive on bulges.
Field curvatureField(const FieldMesh& mesh);

// By how much the field's N-th power turns along a half-edge beyond parallel transport, in [-pi, pi].
double turnAlong(const FieldMesh& mesh, const Field& field, uint32_t halfEdge);

// A place about which the field turns: an inner vertex, or inside a triangle. turns: in N-ths of a whole turn, never 0.
struct Singularity {
    uint32_t triangle = 0;       // of a vertex: one that has it
    uint32_t vertex = kNoIndex;  // kNoIndex: inside the triangle
    int turns = 0;
};
// All of them. On a closed mesh their turns add up to N times the Euler characteristic, exactly.
std::vector<Singularity> singularitiesOf(const FieldMesh& mesh, const Field& field);
glm::dvec3 placeOf(const FieldMesh& mesh, const Singularity& singularity);

}  // namespace espalier
