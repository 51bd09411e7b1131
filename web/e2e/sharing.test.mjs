// Several people at one studio, and pages that have no business there (N6 of the requirements, docs/studio.md).
import assert from "node:assert/strict";
import { once } from "node:events";
import { createServer } from "node:http";
import { after, before, describe, it } from "node:test";
import decodeQR from "qr/decode.js";
import WebSocket from "ws";
import {
  browser,
  distance,
  fetchScene,
  findBarriers,
  openPage,
  poseOf,
  shareBrowser,
  shareStudio,
  signIn,
  stateOf,
  takeByMouse,
  takeOverByMouse,
  takePicture,
  waitForAnswer,
  waitForCalm,
  waitForPicture,
  waitForPlacement,
  waitForRest,
  waitForState,
  waitForView,
  withStudio,
} from "./harness.mjs";

const kBushing = "../products/bushing.step";
const kShaft = 2;

shareBrowser();

describe("somebody who looks on", () => {
  const studio = shareStudio([kBushing]);
  let viewer;
  before(async () => {
    ({ page: viewer } = await openPage(browser, studio.viewer));
    await waitForPicture(viewer);
  });
  after(() => viewer.context().close());

  it("sees the part where the operator moves it, and cannot steer", async () => {
    const { page: operator } = await openPage(browser, studio.operator);
    await waitForPicture(operator);
    assert.equal((await stateOf(viewer)).role, "viewer");
    const start = await poseOf(viewer, kShaft);
    await takeByMouse(operator, kShaft);
    const at = await operator.evaluate((id) => window.hvas.screen(id), kShaft);
    await operator.mouse.move(at.x - 60, at.y - 120, { steps: 6 });
    const led = await waitForRest(operator, kShaft);
    const seen = await waitForRest(viewer, kShaft);
    assert.ok(distance(seen, start) > 0.02, "the part has moved in the viewer's picture");
    assert.ok(distance(seen, led) < 1e-3, `both see it in one place: ${distance(seen, led)} m apart`);
    await takePicture(viewer, "viewer_follows");

    const refused = await viewer.evaluate(async () => {
      const before = window.hvas.state().held.length;
      document.querySelector("canvas").focus();
      return before;
    });
    assert.equal(refused, 1);
    await viewer.keyboard.press("r");
    await waitForAnswer(viewer);
    await waitForPlacement(operator, kShaft, "held");
    assert.equal(await viewer.getByTestId("hint-release").count(), 0);
    await operator.mouse.up();
    await operator.keyboard.press("r");
    await waitForPlacement(viewer, kShaft, "loose");
    await operator.context().close();
  });

  it("cannot send commands or input by hand either", async () => {
    const error = await viewer.evaluate(async () => {
      const socket = new WebSocket(`ws://${location.host}/ws`);
      await new Promise((resolve) => (socket.onopen = resolve));
      socket.send(JSON.stringify({ id: 1, command: "take", hand: 0, occurrence: 2 }));
      return new Promise((resolve) => {
        socket.onmessage = (message) => {
          const said = typeof message.data === "string" ? JSON.parse(message.data) : {};
          if (said.id === 1) {
            resolve(said.error);
          }
        };
      });
    });
    assert.match(error.message, /only the user in control/);
    assert.match(error.remedy, /for viewers/);
    await waitForAnswer(viewer);
    await waitForPlacement(viewer, kShaft, "loose");
  });
});

describe("two operators", () => {
  const studio = shareStudio([kBushing]);
  let first;
  let second;
  before(async () => {
    ({ page: first } = await openPage(browser, studio.operator));
    await waitForPicture(first);
    ({ page: second } = await openPage(browser, studio.operator));
    await waitForPicture(second);
  });
  after(() => first.context().close());

  it("hand over the control, with the part in the hand", async () => {
    assert.equal((await stateOf(second)).hasLease, false);
    await takeByMouse(first, kShaft);
    await first.mouse.up();  // the part stays in the hand until it is let go

    await second.getByTestId("hint-lease").click();
    await first.getByTestId("lease-asked").waitFor();
    await takePicture(first, "lease_asked");
    await takePicture(second, "lease_waits");
    await first.getByTestId("lease-asked").getByRole("button", { name: "Give" }).click();
    await waitForState(second, (state) => state.hasLease);
    await waitForState(first, (state) => !state.hasLease);
    assert.equal(await first.getByTestId("lease-asked").count(), 0);

    const before = await poseOf(second, kShaft);
    await takeOverByMouse(second, kShaft);
    const at = await second.evaluate((id) => window.hvas.screen(id), kShaft);
    await second.mouse.move(at.x + 10, at.y - 60, { steps: 5 });
    assert.ok(distance(await waitForRest(second, kShaft), before) > 0.01, "the second one goes on with it");
    await waitForPlacement(second, kShaft, "held");
    await takePicture(second, "lease_given");
    await second.mouse.up();
    await second.keyboard.press("r");
    await waitForPlacement(second, kShaft, "loose");
  });

  it("find it free where the other one has left", async () => {
    assert.equal((await stateOf(first)).hasLease, false);
    await second.context().close();
    await first.getByTestId("hint-lease").click();
    await waitForState(first, (state) => state.hasLease);
  });
});

describe("a link for others", () => {
  const studio = shareStudio([kBushing]);
  let page;
  before(async () => {
    ({ page } = await openPage(browser, studio.operator));
    await waitForPicture(page);
  });
  after(() => page.context().close());

  async function share(guest) {
    if ((await page.getByTestId("share").count()) === 0) {
      await page.getByTestId("button-share").click();
    }
    await page.getByTestId(`share-${guest}`).click();
    await page.getByTestId(`share-${guest}`).and(page.locator('[aria-checked="true"]')).waitFor();
    await page.waitForFunction(() => /#t=/.test(document.querySelector('[data-testid="share-link"]')?.value ?? ""));
    return page.getByTestId("share-link").inputValue();
  }

  it("is made for whoever is to look on, and shows them the same view", async () => {
    await page.evaluate(() => document.activeElement?.blur());
    await page.keyboard.press("5");  // from above
    await waitForCalm(page);
    const link = await share("viewer");
    assert.match(await page.getByTestId("share-local").innerText(), /this machine only[^]*hvas studio --listen \d/);
    assert.equal(await page.getByTestId("share-qr").count(), 0, "nobody is to scan what leads nowhere");
    await takePicture(page, "share_viewer");
    assert.deepEqual(await findBarriers(page), []);
    for (let k = 0; k < 2; k++) {  // it may be passed on
      const guest = await openPage(browser, link, { isStranger: true });
      await waitForPicture(guest.page);
      assert.equal((await stateOf(guest.page)).role, "viewer");
      assert.equal(new URL(guest.page.url()).hash.includes("t="), false, "the secret is not in the address bar");
      assert.match(new URL(guest.page.url()).hash, /^#view&/);
      const at = (each) => each.evaluate(() => window.hvas.project([0, 0, 0.05]).x / innerWidth);
      await waitForView(guest.page);
      assert.ok(Math.abs((await at(guest.page)) - (await at(page))) < 0.02, "the eye stands where this one does");
      await guest.page.context().close();
    }
  });

  it("is made for whoever is to help, and lets in one browser", async () => {
    const link = await share("operator");
    await takePicture(page, "share_operator");
    const helper = await openPage(browser, link, { isStranger: true });
    await waitForPicture(helper.page);
    assert.equal((await stateOf(helper.page)).role, "operator");
    await helper.page.reload();
    await waitForPicture(helper.page);
    const late = await openPage(browser, link, { isStranger: true });
    await late.page.getByText(/has been used by another browser/).waitFor();
    await takePicture(late.page, "share_spent");
    await page.getByTestId("share-again").click();
    await page.waitForFunction((old) => document.querySelector('[data-testid="share-link"]')?.value !== old, link);
    const next = await openPage(browser, await page.getByTestId("share-link").inputValue(), { isStranger: true });
    await waitForPicture(next.page);
    for (const each of [helper, late, next]) {
      await each.page.context().close();
    }
  });

  it("made by somebody who looks on lets nobody in", async () => {
    const guest = await openPage(browser, studio.viewer);
    await waitForPicture(guest.page);
    await guest.page.getByTestId("button-share").click();
    await guest.page.getByTestId("share-link").waitFor();
    assert.match(await guest.page.getByTestId("share-link").inputValue(), /\/#view&/);
    assert.match(await guest.page.getByTestId("share").innerText(), /already/);
    await guest.page.context().close();
  });
});

describe("a link of a studio that others can reach", () => {
  it("has their address, and a code that a camera reads", withStudio(["--listen", "0.0.0.0"], async (studio) => {
    const here = new URL(studio.operator);
    here.hostname = "127.0.0.1";  // whatever the others are
    const { page } = await openPage(browser, here.href, { ignoreHTTPSErrors: true, isStranger: true });
    await page.getByTestId("empty").waitFor();
    await page.getByTestId("button-share").click();
    await page.getByTestId("share-qr").waitFor();
    assert.equal(await page.getByTestId("share-local").count(), 0);
    await takePicture(page, "share_qr");
    assert.deepEqual(await findBarriers(page), []);
    const origins = page.getByTestId("share-origin");
    if ((await origins.count()) > 0) {
      const all = await origins.getByRole("option").allInnerTexts();
      await origins.selectOption(all.at(-1));
    }
    const link = await page.getByTestId("share-link").inputValue();
    const { data, info } = await page.getByTestId("share-qr").evaluate(async (svg) => {
      const size = 600;
      const canvas = new OffscreenCanvas(size, size);
      const picture = new Image(size, size);
      picture.src = `data:image/svg+xml,${encodeURIComponent(new XMLSerializer().serializeToString(svg))}`;
      await picture.decode();
      const context = canvas.getContext("2d");
      context.drawImage(picture, 0, 0, size, size);
      return { data: [...context.getImageData(0, 0, size, size).data], info: { width: size, height: size } };
    });
    assert.equal(decodeQR({ ...info, data: Uint8Array.from(data) }), link);
    await page.context().close();
  }));
});

describe("what comes from elsewhere", () => {
  /** A page of another origin on the same machine, as anybody could have open. */
  async function withStranger(run) {
    const server = createServer((request, response) => {
      response.writeHead(200, { "Content-Type": "text/html" });
      response.end("<!doctype html><title>elsewhere</title>");
    });
    server.listen(0, "127.0.0.1");
    await once(server, "listening");
    try {
      await run(`http://127.0.0.1:${server.address().port}`);
    } finally {
      server.close();
    }
  }

  it("is refused in a browser that knows the studio's cookie", withStudio([kBushing], (studio) => withStranger(async (elsewhere) => {
    const { page } = await openPage(browser, studio.operator);
    await waitForPicture(page);
    const scene = await fetchScene(page);
    const stranger = await page.context().newPage();
    await stranger.goto(elsewhere);
    const tried = await stranger.evaluate(async (origin) => {
      const read = await fetch(`${origin}/api/scene`, { credentials: "include" }).then((r) => r.text(), () => "refused");
      const sent = await fetch(`${origin}/api/upload?name=a.step`, {
        method: "POST",
        mode: "no-cors",
        credentials: "include",
        body: "ISO-10303-21;",
      }).then((r) => r.type, () => "refused");
      const socket = await new Promise((resolve) => {
        const opened = new WebSocket(`${origin.replace("http", "ws")}/ws`);
        opened.onopen = () => resolve("open");
        opened.onerror = () => resolve("refused");
      });
      return { read, sent, socket };
    }, studio.origin);
    assert.equal(tried.read, "refused", "it cannot read what is open");
    assert.equal(tried.socket, "refused", "it gets no socket");
    // A browser hides the answer to such a request; the server's own word is below.
    assert.ok(["opaque", "refused"].includes(tried.sent));
    assert.equal((await fetchScene(page)).epoch, scene.epoch);
    await page.context().close();
  })));

  it("is refused by the server itself, with and without cookie", withStudio([kBushing], async (studio) => {
    const { cookie } = await signIn(studio.operator);
    const evil = "http://evil.example";
    const upload = (headers) =>
      fetch(`${studio.origin}/api/upload?name=a.step`, { method: "POST", headers, body: "x" }).then((r) => r.status);
    assert.equal(await upload({ Cookie: cookie, Origin: evil }), 403);
    assert.equal(await upload({ Cookie: cookie, Origin: `${studio.origin}.evil.example` }), 403);
    assert.equal(await upload({ Origin: studio.origin }), 401);
    assert.equal((await fetch(`${studio.origin}/api/scene`)).status, 401);
    assert.equal((await fetch(`${studio.origin}/api/scene`, { headers: { Cookie: "hvas=00" } })).status, 401);

    const upgrade = (headers) =>
      new Promise((resolve) => {
        const socket = new WebSocket(`${studio.origin.replace("http", "ws")}/ws`, { headers });
        socket.on("open", () => resolve(101) || socket.close());
        socket.on("unexpected-response", (_, response) => resolve(response.statusCode));
        socket.on("error", () => {});
      });
    assert.equal(await upgrade({ Cookie: cookie, Origin: evil }), 403);
    assert.equal(await upgrade({ Origin: studio.origin }), 401);
    assert.equal(await upgrade({ Cookie: cookie, Origin: studio.origin, Host: "evil.example" }), 403);
    assert.equal(await upgrade({ Cookie: cookie, Origin: studio.origin }), 101);
  }));
});
