// Last step of the picture: depth of field (gathered in one pass over the depth buffer), tone mapping, and the merging of the
// two eyes for red-cyan glasses.
import * as THREE from "three";
import { FullScreenQuad } from "three/examples/jsm/postprocessing/Pass.js";

const kMaxBlur = 16; // [pixel]
const kDeepest = 7; // [mm], defocus up to which blur is told apart

const kVertex = /* glsl */ `
varying vec2 vUv;
void main() { vUv = uv; gl_Position = vec4(position.xy, 0.0, 1.0); }`;

const kFragment = /* glsl */ `
#include <common>
#include <tonemapping_pars_fragment>
varying vec2 vUv;
uniform sampler2D picture;
uniform sampler2D depth;
uniform vec2 texel;
uniform float near;
uniform float far;
uniform float focus;     // distance of the focal plane [mm]
uniform float blurScale; // [pixel] of blur radius per unit of |d - focus| / d
uniform float maxBlur;  // [pixel], largest radius gathered
uniform bool encode;

float distanceAt(vec2 at) {
  float z = texture2D(depth, at).x;
  return near * far / (far - z * (far - near));
}
float blurAt(float d) { return clamp(abs(d - focus) / d * blurScale, 0.0, maxBlur); }

vec3 gathered() {
  vec3 sum = texture2D(picture, vUv).rgb;
#if SAMPLES > 0
  float centre = distanceAt(vUv), own = blurAt(centre), total = 1.0;
  // a fixed turn of the sample disc from pixel to pixel hides its pattern
  float start = 6.2831853 * fract(52.9829189 * fract(dot(gl_FragCoord.xy, vec2(0.06711056, 0.00583715))));
  for (int i = 1; i <= SAMPLES; ++i) {
    float f = float(i);
    float radius = maxBlur * sqrt(f / float(SAMPLES));
    float angle = start + f * 2.39996323;
    vec2 at = vUv + vec2(cos(angle), sin(angle)) * radius * texel;
    float d = distanceAt(at), size = blurAt(d);
    if (d > centre) size = min(size, own * 2.0);
    float take = smoothstep(radius - 0.75, radius + 0.75, size);
    sum += mix(sum / total, min(texture2D(picture, at).rgb, vec3(12.0)), take);
    total += 1.0;
  }
  sum /= total;
#endif
  return sum;
}

void main() {
  vec3 colour = ACESFilmicToneMapping(gathered());
  gl_FragColor = vec4(encode ? sRGBTransferOETF(vec4(colour, 1.0)).rgb : colour, 1.0);
}`;

const kAnaglyph = /* glsl */ `
varying vec2 vUv;
uniform sampler2D left;
uniform sampler2D right;
void main() {
  // Least-squares matrices for red-cyan glasses (Dubois 2001, table for broad-band displays), in linear light.
  vec3 l = texture2D(left, vUv).rgb, r = texture2D(right, vUv).rgb;
  vec3 colour = vec3(
    dot(l, vec3( 0.4561,  0.500484,  0.176381)) + dot(r, vec3(-0.0434706, -0.0879388, -0.00155529)),
    dot(l, vec3(-0.0400822, -0.0378246, -0.0157589)) + dot(r, vec3( 0.378476,  0.73364, -0.0184503)),
    dot(l, vec3(-0.0152161, -0.0205971, -0.00546856)) + dot(r, vec3(-0.0721527, -0.112961,  1.2264)));
  gl_FragColor = sRGBTransferOETF(vec4(clamp(colour, 0.0, 1.0), 1.0));
}`;

export class FinishPass {
  private readonly material: THREE.ShaderMaterial;
  private readonly merge: THREE.ShaderMaterial;
  private readonly quad: FullScreenQuad;
  private readonly mergeQuad: FullScreenQuad;

  constructor() {
    this.material = new THREE.ShaderMaterial({
      vertexShader: kVertex, fragmentShader: kFragment, depthTest: false, depthWrite: false, toneMapped: false,
      defines: { SAMPLES: 0 },
      uniforms: {
        picture: { value: null }, depth: { value: null }, texel: { value: new THREE.Vector2() }, near: { value: 1 },
        far: { value: 2 }, focus: { value: 200 }, blurScale: { value: 0 }, toneMappingExposure: { value: 1 }, maxBlur: { value: 1 }, encode: { value: true },
      },
    });
    this.merge = new THREE.ShaderMaterial({
      vertexShader: kVertex, fragmentShader: kAnaglyph, depthTest: false, depthWrite: false, toneMapped: false,
      uniforms: { left: { value: null }, right: { value: null } },
    });
    this.quad = new FullScreenQuad(this.material);
    this.mergeQuad = new FullScreenQuad(this.merge);
  }

  setSamples(samples: number): void {
    if (this.material.defines.SAMPLES === samples) return;
    this.material.defines.SAMPLES = samples;
    this.material.needsUpdate = true;
  }

  develop(renderer: THREE.WebGLRenderer, source: THREE.WebGLRenderTarget, target: THREE.WebGLRenderTarget | null,
          camera: THREE.PerspectiveCamera, focus: number, blurScale: number): void {
    const u = this.material.uniforms;
    u.picture.value = source.texture;
    u.depth.value = source.depthTexture;
    u.texel.value.set(1 / source.width, 1 / source.height);
    u.near.value = camera.near;
    u.far.value = camera.far;
    u.focus.value = focus;
    u.blurScale.value = blurScale;
    u.maxBlur.value = Math.min(kMaxBlur, (blurScale * kDeepest) / focus);
    u.encode.value = target === null;
    renderer.setRenderTarget(target);
    this.quad.render(renderer);
  }

  mergeEyes(renderer: THREE.WebGLRenderer, left: THREE.WebGLRenderTarget, right: THREE.WebGLRenderTarget): void {
    this.merge.uniforms.left.value = left.texture;
    this.merge.uniforms.right.value = right.texture;
    renderer.setRenderTarget(null);
    this.mergeQuad.render(renderer);
  }
}
