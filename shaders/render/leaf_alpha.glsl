// Which part of a pixel a cut-out leaf covers. Of one sample: all of it or none.
#ifndef ESPALIER_RENDER_LEAF_ALPHA_GLSL
#define ESPALIER_RENDER_LEAF_ALPHA_GLSL
#ifdef ESPALIER_ONE_SAMPLE
#define CUT_OUT(alpha, cutoff, which)               \
    if ((cutoff) > 0.0 && (alpha) < (cutoff)) discard;
#else
// Sharpened to a pixel's width around the cutoff, so that minified leaves neither swell nor vanish.
#define CUT_OUT(alpha, cutoff, which)                                                                             \
    gl_SampleMask[0] = (cutoff) > 0.0 ? coverage(((alpha) - (cutoff)) / max(fwidth(alpha), 1e-3) + 0.5, which) : 255;
#endif
#endif
