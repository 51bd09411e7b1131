/** How the surface of a material looks, told by the name of the material. */

export interface Finish {
  /** Of the microfacets, 0 to 1. */
  roughness: number;
  /** Share of light that is reflected as by a metal, 0 to 1. */
  metalness: number;
}

/** What a part without a material, or with an unknown one, looks like. */
export const kPlainFinish: Finish = { roughness: 0.5, metalness: 0.12 };

/** The first that fits holds: a cast iron is no steel, and "rubber" is in no name of a metal. Designations are those of
 EN 10027, EN 573, EN 1412 and ISO 1043. All numbers were chosen by eye; metals keep a share of the colour that they are
 drawn with in CAD. */
const kFinishes: readonly (readonly [RegExp, Finish])[] = [
  [/\b(nbr|hnbr|epdm|fkm|fpm|viton|rubber|silicone?|gummi|elastomer|neoprene?)\b/, { roughness: 0.93, metalness: 0 }],
  [/\b(abs|pa ?\d*|pom|ptfe|peek|petg?|pla|pvc|pc|pe|hdpe|pp|nylon|teflon|acetal|plastic|polymer|kunststoff|resin)\b/, { roughness: 0.6, metalness: 0 }],
  [/\b(wood|beech|oak|holz|cork|paper|felt|aramid|fibre|fiber)\b/, { roughness: 0.87, metalness: 0 }],
  [/cast iron|gusseisen|\bgrauguss\b|\b(en-)?gj[lsmv]/, { roughness: 0.6, metalness: 0.53 }],
  [/alumin|\ben[ -]?aw\b|\bal[ -]?(mg|si|cu|zn)|\b(6061|6082|7075|5083|2024)\b/, { roughness: 0.47, metalness: 0.67 }],
  [/bronze|brass|copper|messing|kupfer|rotguss|\bcu(sn|zn|al|ni)/, { roughness: 0.33, metalness: 0.8 }],
  [/steel|stahl|stainless|\b[sc]\d{2,3}\b|\bx\d+cr|\b\d{2}mncr|\b\d{2}crmo|\b1\.[0-4]\d{3}\b|titan|zinc|\bzink\b|nickel|chrom/, { roughness: 0.4, metalness: 0.73 }],
];

/** @param material  Its name or designation, in English or German; empty: not known. */
export function finishOf(material: string): Finish {
  const name = material.toLowerCase();
  return kFinishes.find(([names]) => names.test(name))?.[1] ?? kPlainFinish;
}

/** Steps of both numbers in a code. */
const kSteps = 15;

/** Packs a finish into a whole number above 0, which a channel of a texture carries. */
export function encodeFinish({ roughness, metalness }: Finish): number {
  return 1 + (kSteps + 1) * Math.round(kSteps * metalness) + Math.round(kSteps * roughness);
}
