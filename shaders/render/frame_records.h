// What the drawing shaders read: the frame, and each draw's push data.
#ifndef ESPALIER_RENDER_FRAME_RECORDS_H
#define ESPALIER_RENDER_FRAME_RECORDS_H
#include "shaders/emit/emit_records.h"
#include "shaders/paint/brush.h"

ESPALIER_BEGIN

CONST_UINT(kViewShaded, 0u);
CONST_UINT(kViewCharts, 1u);
CONST_UINT(kViewNormals, 2u);
CONST_UINT(kViewLod, 3u);
CONST_UINT(kViewLayer, 4u);
CONST_UINT(kViewDepth, 5u);
CONST_UINT(kViewOverdraw, 6u);

// Three numbers of layers in FrameRecord::layer, where the view of a layer shows one of colours.
CONST_UINT(kColourLayers, 1u << 24u);
FN uint colourLayers(uint red, uint green, uint blue) { return kColourLayers | red | (green << 8u) | (blue << 16u); }
FN bool isColourLayers(uint layer) { return (layer >> 24u) == 1u; }

CONST_FLOAT(kNoGround, -1e30f);   // below everything

CONST_FLOAT(kHighestHill, 0.075f);   // sine of its height over the horizon

CONST_FLOAT(kTonesPerUnit, 2.3f);   // radians
CONST_FLOAT(kGustTurns, 1.6f);      // radians of a gust in a metre
// Factors of places in the phase by which gusts differ.
#define ESPALIER_GUST_PHASE vec3(1.1f, 1.7f, 1.3f)

// Colours are linear. Clip space: depth reversed, 1 at the near plane, 0 at infinity.
struct FrameRecord {
    mat4 viewProjection;
    mat4 shadowMatrix;       // world -> near shadow map: xy texture coordinates in its half, z depth
    vec3 eye;
    float nearPlane;
    vec3 sunDirection;       // towards the sun, unit
    float shadowOffset;      // metres along the normal that lookups start from
    vec3 sunColor;
    float exposure;          // factor
    vec3 skyColor;
    uint view;
    vec3 groundColor;
    uint layer;              // that is seen, or colourLayers; of charts: their level
    vec3 background;
    uint shadows;
    vec3 horizon;
    float shadowTexel;       // 1 / side of each half of the shadow map
    vec3 rayRight;           // half the picture's width at distance 1
    float pixelScale;        // pixels of one metre at one metre's distance
    vec3 rayUp;
    float unit;              // what a metre is for models that come in other units: sizes of the look are in it
    vec3 rayForward;
    float groundLevel;       // height of the ground that is drawn to the horizon; kNoGround: none is
    SurfaceBuf surfaces;
    LayerBuf layers;
    float layerOpacity;      // over the model
    BrushLimits limits;      // of a brush: the layer is hatched where they let less paint pass
    vec3 grassColor;         // of the ground that is drawn
    vec2 siteLow, siteRcp;   // the site's map: its corner, 1 / its size; world, metres; 0: there is none
    vec3 wideScale, wideOffset;   // coordinates in the near shadow map -> in the wide one
    vec3 wind;               // the way it blows, unit
    float windBend;          // how far leaves lean that way, in their length; of programs that know of wind
    vec3 windTurns;          // how far gusts, leaning and fluttering are in their turns, radians
    float windGusts;         // 0 to 1: how much of the wind comes in gusts
    vec2 studioAt;           // x and z of the middle of a studio's floor; world, metres
    float studioRadius;      // 0: the ground is none
    float night;             // 1: so little light that eyes hardly tell colours apart; 0: enough
    vec2 ditherFrom;         // pixels: pictures that lie fractions of a pixel apart leave out other pixels of thin twigs
    vec2 shadowTap;          // the first of four places around one in the map of shadows, in 3/4 texels; the others lie a quarter turn on
    vec3 tonesFrom;          // where the tones of leaves begin, in their turns; they and gusts stay where they are when the
    float gustsFrom;         // world's origin moves; radians
};
STATIC_SIZE(FrameRecord, 464);

struct ModelPush {
    vec4 toWorld[3];         // rows
    vec4 baseColor;
    float normalScale;
    float roughness;
    float alphaCutoff;
    uint surface;            // instance; kNoIndex: no walk data
    float fade;              // 1: all pixels; above 0: this share of them; below: those that -fade leaves out
    uint lod;                // 0: the mesh; then its coarser ones
    uint colorOther;         // 1: the base colour is looked up in the second UV set
    uint mirrored;           // 1: by toWorld
    vec3 colorU, colorV;     // rows by which (u, v, 1) of it are multiplied; read by programs of such materials only
};
STATIC_SIZE(ModelPush, 120);

// What few materials have: maps of their textures, as ModelPush has that of the base colour, light of their own, metal.
struct MaterialRecord {
    vec3 normalU, normalV;
    vec3 emissiveU, emissiveV;
    vec3 emissive;
    uint normalOther, emissiveOther;
    float transmission;
    vec3 roughnessU, roughnessV;
    uint roughnessOther;
    float metallic;
};
STATIC_SIZE(MaterialRecord, 104);

struct TerminalPush {
    uint bucket, firstVertex, vertexCount, batch;
    vec4 baseColor;
    float roughness;
    float alphaCutoff;
    uint spare[2];
};
STATIC_SIZE(TerminalPush, 48);

// Push data of the kernels that light what has four vertices before it is drawn (lit.glsl).
struct LightPush {
    TerminalPush draw;
    U64Buf lit;
};
STATIC_SIZE(LightPush, 56);
CONST_UINT(kLitVertices, 4u);                // at most, of one instance there
CONST_UINT(kLitTexels, 2u + kLitVertices);   // each four 32-bit words
CONST_UINT(kLitWords, 2u * kLitTexels);      // of 64 bits

struct PostPush {
    vec2 rcpSize;            // 1 / pixels
    uint encode;             // 1: the target doesn't encode to sRGB itself
    uint spare;
};
STATIC_SIZE(PostPush, 16);

struct TilesPush {
    FloatBuf tiles;
};
STATIC_SIZE(TilesPush, 8);

struct RestorePush {
    FloatBuf tiles;          // kKeptTile or kChangedTile
    uint columns;            // tiles along a side
    uint spare;
};
STATIC_SIZE(RestorePush, 16);

ESPALIER_END
#endif
