// Growth stands in the map of shadows alone: everywhere else its vertices lie outside of the view.
void MAIN() {
#if QSSG_ENABLE_ORTHO_SHADOW_PASS
    POSITION = MODELVIEWPROJECTION_MATRIX * vec4(VERTEX, 1.0);
#else
    POSITION = vec4(2.0, 2.0, 2.0, 1.0);
#endif
}
