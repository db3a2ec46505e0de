// Said on the form and on the result, so that nobody takes an estimate for a mark, or many lapses for a good join.
import type { Scale } from "../messages";

export const stitchHint = "Mark the finished work as you see it under Watch, which hides what the simulator found. Other raters' marks and the simulator's estimates appear when yours are stored; giving marks again replaces yours.";
export const formsHint = "Each form is stored by itself. Fill in all of them first: what one shows once it is stored could lead you in the next.";

export function better(scale: Scale): string {
  return scale.better === "fewer" ? "Fewer points are better: each is a kind of lapse." : "More points are better.";
}
