import encodeQR from "qr";
import decodeQR from "qr/decode.js";
import { describe, expect, it } from "vitest";
import { encodeView, withToken } from "../src/model/view_link";

/** As a camera sees it: so many pixels for a module. */
function photograph(rows: readonly (readonly boolean[])[], scale = 6): { width: number; height: number; data: Uint8Array } {
  const size = rows.length * scale;
  const data = new Uint8Array(4 * size * size).fill(255);
  rows.forEach((row, y) =>
    row.forEach((isDark, x) => {
      for (let k = 0; isDark && k < scale * scale; k++) {
        const at = 4 * ((y * scale + Math.floor(k / scale)) * size + x * scale + (k % scale));
        data.fill(0, at, at + 3);
      }
    }),
  );
  return { width: size, height: size, data };
}

describe("the code of a link", () => {
  it("is read back by a camera, short and long", () => {
    const view = { eye: [0.1, -0.25, 0.3], target: [0, 0, 0.05], isOrthographic: false, explode: 0, section: null } as const;
    for (const hidden of [[], Array.from({ length: 100 }, (_, k) => 10 * k)]) {
      const fragment = encodeView({ ...view, hidden, ghosted: [], selected: [] });
      const link = `https://192.168.1.5:8443/#${withToken("AbC-_0123456789abcdefghijklmnopq", fragment)}`;
      expect(decodeQR(photograph(encodeQR(link, "raw", { ecc: "medium", border: 4 })))).toBe(link);
    }
  });
});
