// Shadows for machines without a graphics chip: every object drawn once more, pressed flat onto the sheet along the light.
// The stencil keeps overlapping shadows from darkening twice.
import * as THREE from "three";

export class FlatShadows {
  readonly group = new THREE.Group();
  private readonly pairs: { from: THREE.Mesh; to: THREE.Mesh }[] = [];
  private readonly press = new THREE.Matrix4();
  private readonly material = new THREE.MeshBasicMaterial({
    color: 0x03100f, transparent: true, opacity: 0.42, depthWrite: false, toneMapped: false, polygonOffset: true, polygonOffsetFactor: -2, polygonOffsetUnits: -2,
    stencilWrite: true, stencilRef: 1, stencilFunc: THREE.NotEqualStencilFunc, stencilZPass: THREE.ReplaceStencilOp, side: THREE.DoubleSide,
  });

  /// Shadows of all meshes below `content` that cast one.
  follow(content: THREE.Object3D): void {
    this.group.clear();
    this.pairs.length = 0;
    content.traverse((object) => {
      if (!(object instanceof THREE.Mesh) || !object.castShadow) return;
      const shadow = new THREE.Mesh(object.geometry, this.material);
      shadow.matrixAutoUpdate = shadow.matrixWorldAutoUpdate = false;
      shadow.frustumCulled = false;
      shadow.morphTargetInfluences = object.morphTargetInfluences;
      this.pairs.push({ from: object, to: shadow });
      this.group.add(shadow);
    });
  }

  /// `light`: towards the lamp; `height` [mm]: of the sheet. Call after the objects have been moved.
  update(light: THREE.Vector3, height: number): void {
    const x = light.x / light.z, y = light.y / light.z, lifted = height + 0.01;
    this.press.set(1, 0, -x, x * lifted, 0, 1, -y, y * lifted, 0, 0, 0, lifted, 0, 0, 0, 1);
    for (const { from, to } of this.pairs) {
      from.updateWorldMatrix(true, false);
      to.matrixWorld.multiplyMatrices(this.press, from.matrixWorld);
    }
  }
}
