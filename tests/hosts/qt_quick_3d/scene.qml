// The engine's scene: a model from a file, a ball in front of it, and a sun whose shadows fall on both. Ivy isn't here: it is
// drawn into the engine's pass. Its triangles take part in the engine's map of shadows alone.
import QtQuick
import QtQuick3D
import QtQuick3D.AssetUtils

Item {
    property bool ball: true
    property bool casting: false
    property alias camera: camera
    property alias sun: sun

    View3D {
        anchors.fill: parent
        renderMode: View3D.Underlay
        PerspectiveCamera {
            id: camera
            position: Qt.vector3d(1.2, 1.9, 6.2)
            eulerRotation: Qt.vector3d(-4, 12, 0)
            fieldOfView: 50
            clipNear: 0.1
            clipFar: 100
        }
        DirectionalLight {
            id: sun
            eulerRotation: Qt.vector3d(-38, -24, 0)
            brightness: 1.2
            ambientColor: "#404858"
            castsShadow: true
            shadowMapQuality: Light.ShadowMapQualityVeryHigh
            shadowFactor: 90
            shadowBias: 0.1
            shadowMapFar: 20
        }
        RuntimeLoader { source: modelFile }
        Model {
            visible: ball
            source: "#Sphere"
            position: Qt.vector3d(0.4, 1.3, 2.4)
            scale: Qt.vector3d(0.007, 0.007, 0.007)
            castsShadows: false
            materials: DefaultMaterial { lighting: DefaultMaterial.NoLighting; diffuseColor: "#ff00ff" }
        }
        Model {
            visible: casting
            geometry: shadowCaster
            receivesShadows: false
            materials: CustomMaterial {
                shadingMode: CustomMaterial.Unshaded
                cullMode: Material.NoCulling
                vertexShader: "caster.vert"
            }
        }
    }
}
