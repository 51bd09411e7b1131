import { describe, expect, it } from "vitest";
import { csvText } from "../src/model/csv";

describe("a table that is saved", () => {
  it("has no cell that a spreadsheet takes for a formula", () => {
    for (const text of ["=1+1", "+1+1", "-1+1", "@SUM(A1)", "\t=1", "\r=1", " =1", "'=1", "\uff1d1", "--1", "-1e5+A1"]) {
      expect(csvText([[text]]).replace(/^"/, "").startsWith("'"), JSON.stringify(text)).toBe(true);
    }
    expect(csvText([['=HYPERLINK("http://x";"y")']])).toBe('"\'=HYPERLINK(""http://x"";""y"")"\n');
  });

  it("keeps numbers as numbers and plain texts as they are", () => {
    expect(csvText([["part", -1.5, 1e-7, NaN, "-1.5", "bolt M8", "a=b", "H7/p6"]])).toBe("part,-1.5,1e-7,,-1.5,bolt M8,a=b,H7/p6\n");
    expect(csvText([["a;b", 'say "no"', "x,y", "two\nlines", " x"]])).toBe('"a;b","say ""no""","x,y","two\nlines"," x"\n');
  });
});
